// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The 3D position of a click: an echo, or the drawn surface. The server's ray refines the position if
// it hits the same surface.

import { Raycaster, type Vector3 } from 'three';
import type { Click } from '../driving/pointer';
import type { Live } from '../server/live';
import type { ScanCloud } from '../picture/scan_cloud';
import type { SceneView } from '../picture/scene_view';

const kEchoPixels = 5;
/** An echo counts if it is at most this far behind the drawn surface. */
const kEchoBeforeM = 0.3;
/** Tolerance for merged splats and their tips: a fraction of the distance, and a minimum. */
const kSameSurface = 0.01;
const kSameSurfaceM = 0.15;

export class SurfaceFinder {
  private before: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly view: SceneView,
    private readonly live: Live,
    private readonly clouds: ScanCloud[],
  ) {}

  /** Null: no surface. Resolves in the order of the clicks. */
  at(click: Click): Promise<Vector3 | null> {
    const { before } = this;
    const found = this.find(click);
    this.before = found.catch(() => {});
    return before.then(() => found);
  }

  private async find({ screen, pixel }: Click): Promise<Vector3 | null> {
    const { camera } = this.view.rig;
    const eye = camera.position.clone();
    const seen = this.view.surfaceAt(screen, pixel);
    for (const cloud of this.clouds) {
      const echo = cloud.nearest(camera, screen.x, screen.y, this.view.height_px, kEchoPixels);
      if (!echo || !this.view.clip.shows(echo.position)) continue;
      if (!seen || echo.position.distanceTo(eye) < seen.distanceTo(eye) + kEchoBeforeM)
        return echo.position;
    }
    if (!seen) return null;
    const caster = new Raycaster();
    caster.setFromCamera(screen, camera);
    const { origin, direction } = caster.ray;
    const found = await this.live.pick(origin.toArray(), direction.toArray());
    if (!found?.hit) return seen;
    const exact = origin.clone().addScaledVector(direction, found.range_m);
    const tolerance = Math.max(kSameSurfaceM, kSameSurface * seen.distanceTo(eye));
    return exact.distanceTo(seen) < tolerance ? exact : seen;
  }
}
