// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A click into the scene: what the server's ray meets there, and the echo that was meant.

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

  /** `place` on the camera's screen, -1..1; the card says how far it is from the sensor. */
  async pick(place: Vector2, sensor: Vector3) {
    const { camera } = this.view.rig;
    const caster = new Raycaster();
    caster.setFromCamera(place, camera);
    const { origin, direction } = caster.ray;
    let echo = null;
    for (const cloud of this.clouds)
      echo ??= cloud.nearest(camera, place.x, place.y, this.view.height_px, kEchoPixels);
    const found = await this.live.pick(origin.toArray(), direction.toArray());
    // An echo behind what the ray meets is not what was clicked.
    const hidden = echo && found?.hit && echo.position.distanceTo(origin) > found.range_m + 0.5;
    this.card.show(found, hidden ? null : echo, sensor);
  }

  hide() {
    this.card.hide();
  }
}
