// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Controls of the camera and of the driven sensor.

import type { CameraModes } from '../driving/camera_modes';
import { button, make, row, checkbox } from './dom';
import type { DrivenSensor } from '../driving/driven_sensor';
import type { SceneSource } from '../scene_source';

export class DrivePanel {
  readonly element = make('div');
  private readonly speed = make('span', { className: 'value', textContent: '0 km/h' });

  constructor(
    source: SceneSource,
    cameras: CameraModes,
    private readonly sensor: DrivenSensor,
  ) {
    const { driver } = sensor;
    this.element.append(cameras.element);
    if (!source.scene.can_simulate) return;
    this.element.append(
      checkbox('Keep the height above ground', driver.followGround, (on) =>
        driver.setFollowGround(on),
      ),
      row('Speed', this.speed),
      make(
        'div',
        { className: 'buttons small' },
        button('Start pose', 'Return to the start pose', () =>
          sensor.setPose(source.scene.start_pose),
        ),
        button('Clear path', 'Start a new path at the current pose', () => sensor.clearPath()),
      ),
    );
  }

  showSpeed() {
    this.speed.textContent = `${(3.6 * this.sensor.driver.speed_m_s).toFixed(0)} km/h`;
  }
}
