// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The picture as a file.

import { byId, download } from '../panels/dom';
import { showToast } from '../panels/notices';
import type { SceneView } from '../picture/scene_view';

export function saveScreenshot(view: SceneView, sceneName: string) {
  view.drawNow();
  byId<HTMLCanvasElement>('view').toBlob((blob) => {
    if (!blob) return showToast('The picture could not be made');
    download(`${sceneName.replace(/[^\w.-]+/g, '_')}.png`, blob);
  }, 'image/png');
}
