// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Creates the tools.

import { yawOf } from '../driving/pose';
import type { DrivenSensor } from '../driving/driven_sensor';
import type { Labels } from '../picture/labels';
import type { ScanCloud } from '../picture/scan_cloud';
import type { SceneView } from '../picture/scene_view';
import type { Live } from '../server/live';
import type { Vec3 } from '../server/protocol';
import { ClipTool } from './clip_tool';
import { MeasureTool } from './measure';
import { ProfileTool } from './profile';
import { SurfaceFinder } from './surface';
import type { Tool } from './tool_box';

export class Tools {
  readonly measure: MeasureTool;
  readonly clip: ClipTool;
  readonly profile: ProfileTool;

  constructor(
    view: SceneView,
    live: Live,
    clouds: ScanCloud[],
    labels: Labels,
    sensor: DrivenSensor,
    origin_m: Vec3,
    failed: (error: unknown) => void,
  ) {
    const surface = new SurfaceFinder(view, live, clouds);
    this.measure = new MeasureTool(view, surface, labels, origin_m);
    this.clip = new ClipTool(view, origin_m, () => ({
      position: sensor.body.object.position,
      yaw_rad: yawOf(sensor.body.object.quaternion),
    }));
    this.profile = new ProfileTool(view, surface, origin_m, failed);
  }

  get all(): Tool[] {
    return [this.measure, this.clip, this.profile];
  }
}
