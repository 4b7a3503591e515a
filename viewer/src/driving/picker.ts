// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Shows what was clicked: the splat that the server's ray hits, and the nearest echo.

import { Raycaster, type Vector2, type Vector3 } from 'three';
import { byId } from '../panels/dom';
import type { Live } from '../server/live';
import { PickCard } from '../panels/pick_card';
import type { Vec3 } from '../server/protocol';
import type { ScanCloud } from '../picture/scan_cloud';
import type { SceneView } from '../picture/scene_view';

const kEchoPixels = 5;

export class Picker {
  private readonly card: PickCard;

  constructor(
    private readonly view: SceneView,
    private readonly live: Live,
    private readonly clouds: ScanCloud[],
    origin_m: Vec3,
  ) {
    this.card = new PickCard(byId('card'), view.palette, origin_m);
  }

  /** `screen`: on the camera's screen, -1..1. The card shows the distance from `sensor`. */
  async pick(screen: Vector2, sensor: Vector3) {
    const { camera } = this.view.rig;
    const caster = new Raycaster();
    caster.setFromCamera(screen, camera);
    const { origin, direction } = caster.ray;
    let echo = null;
    for (const cloud of this.clouds)
      echo ??= cloud.nearest(camera, screen.x, screen.y, this.view.height_px, kEchoPixels);
    const found = await this.live.pick(origin.toArray(), direction.toArray());
    // An echo behind the hit surface was not clicked.
    const hidden = echo && found?.hit && echo.position.distanceTo(origin) > found.range_m + 0.5;
    this.card.show(found, hidden ? null : echo, sensor);
  }

  hide() {
    this.card.hide();
  }
}
