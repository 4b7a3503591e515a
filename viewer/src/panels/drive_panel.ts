// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// How the camera moves, and the sensor where one is driven.

import type { CameraModes } from '../driving/camera_modes';
import { button, make, row, tick } from './dom';
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
      tick('Keep the height over the ground', driver.followGround, (on) =>
        driver.setFollowGround(on),
      ),
      row('Speed', this.speed),
      make(
        'div',
        { className: 'buttons small' },
        button('Start pose', 'Back to where it began', () =>
          sensor.setPose(source.scene.start_pose),
        ),
        button('Clear path', 'The path begins here', () => sensor.clearPath()),
      ),
    );
  }

  showSpeed() {
    this.speed.textContent = `${(3.6 * this.sensor.driver.speed_m_s).toFixed(0)} km/h`;
  }
}
