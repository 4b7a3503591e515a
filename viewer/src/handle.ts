// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// window.adasplats: for tests and for the console.

import { Vector3 } from 'three';
import type { CameraMode } from './driving/camera_rig';
import { byId } from './panels/dom';
import type { CameraModes } from './driving/camera_modes';
import type { CommandDialog } from './panels/command_dialog';
import type { DrivenSensor } from './driving/driven_sensor';
import type { SidePanel } from './panels/side_panel';
import type { LidarPanel } from './panels/lidar_panel';
import type { Live } from './server/live';
import { floatsOf, kScanPointWords, type ScanPacket } from './server/binary';
import type { Pose } from './server/protocol';
import type { Playback } from './playback';
import type { Tools } from './tools/tools';
import type { WorldObjects } from './picture/world_objects';
import type { ScanCloud } from './picture/scan_cloud';
import type { ScanRate } from './live_scans';
import type { SceneView } from './picture/scene_view';
import { kColorModes } from './picture/shaders';

export interface HandleParts {
  view: SceneView;
  live: Live;
  rate: ScanRate;
  cloud: ScanCloud;
  sensor: DrivenSensor;
  lidar: LidarPanel;
  playback: Playback;
  tools: Tools;
  objects: WorldObjects;
  cameras: CameraModes;
  panel: SidePanel;
  dialog: CommandDialog;
}

export function publishHandle(parts: HandleParts) {
  const handle = { state: () => stateOf(parts), ...actionsOf(parts), ...picturesOf(parts.view) };
  (window as unknown as { adasplats: unknown }).adasplats = handle;
}

function stateOf(parts: HandleParts) {
  const { view, live, lidar, rate, cloud } = parts;
  const { driver } = parts.sensor;
  return {
    ...workState(parts),
    ...view.statistics,
    connected: live.connected,
    scansReceived: rate.received,
    scansPerSecond: rate.perSecond(performance.now()),
    scan: cloud.packet && scanState(cloud.packet),
    sensor: lidar.confirmed?.name ?? null,
    settings: lidar.confirmed?.settings ?? null,
    pose: driver.pose,
    speed_m_s: driver.speed_m_s,
    pathPoses: driver.finishedPath().length,
    running: lidar.running,
    colorMode: view.colorMode,
    camera: {
      eye: view.rig.camera.position.toArray(),
      target: view.rig.controls.target.toArray(),
      mode: view.rig.mode,
    },
    software: view.stage.software,
  };
}

function workState({ view, playback, tools, objects }: HandleParts) {
  const { timeline, source, packet } = playback;
  return {
    time_s: timeline?.time_s ?? null,
    duration_s: timeline?.duration_s ?? null,
    playing: timeline?.playing ?? false,
    scanSource: source,
    shownScan: packet?.number ?? null,
    measurements: tools.measure.all.map(({ from, to, distance_m }) => ({
      from: from.toArray(),
      to: to.toArray(),
      distance_m,
    })),
    profilePoints: tools.profile.points.length,
    clip: { mode: view.clip.mode, half: view.clip.half.toArray() },
    objects: objects.objects.map(({ info }, i) => ({ name: info.name, pose: objects.poseOf(i) })),
    layers: view.layers.map(({ info, visible }) => ({ name: info.name, kind: info.kind, visible })),
  };
}

function scanState(packet: ScanPacket) {
  const { number, points, rings, columns, rays, seconds, pose } = packet;
  const floats = floatsOf(packet);
  let maxRange_m = 0;
  for (let i = 0; i < floats.length; i += kScanPointWords)
    maxRange_m = Math.max(maxRange_m, floats[i] ** 2 + floats[i + 1] ** 2 + floats[i + 2] ** 2);
  return { number, points, rings, columns, rays, seconds, pose, maxRange_m: Math.sqrt(maxRange_m) };
}

function actionsOf(parts: HandleParts) {
  const { view, lidar } = parts;
  return {
    setPose: (pose: Pose) => parts.sensor.setPose(pose),
    setColor: (mode: string) => {
      const known = kColorModes.find((m) => m === mode);
      if (known) parts.panel.chooseColor(known);
    },
    setSensor: (name: string) => lidar.chooseSensor(name),
    setSetting: (key: string, value: number | boolean | null) => lidar.set(key, value),
    setRunning: (on: boolean) => lidar.setRunning(on),
    setCameraMode: (mode: CameraMode) => parts.cameras.choose(mode),
    setCamera: ({ eye, target }: { eye: number[]; target: number[] }) => {
      view.rig.set(new Vector3(...eye), new Vector3(...target));
      view.moved();
    },
    command: () => parts.dialog.command,
    /** Number of echoes of the live scan within `reach_m` of a position. */
    echoesNear: (position: number[], reach_m: number) => {
      const { packet, object } = parts.cloud;
      if (!packet) return 0;
      const floats = floatsOf(packet);
      const middle = new Vector3(...position);
      const echo = new Vector3();
      let found = 0;
      for (let i = 0; i < floats.length; i += kScanPointWords) {
        echo.set(floats[i], floats[i + 1], floats[i + 2]).applyMatrix4(object.matrix);
        if (echo.distanceTo(middle) < reach_m) ++found;
      }
      return found;
    },
    posesCsv: () => parts.dialog.poses,
  };
}

function picturesOf(view: SceneView) {
  return {
    /** Position of a scene point on the page, in pixels; null behind the camera. */
    project: (x: number, y: number, z: number) => {
      const at = new Vector3(x, y, z).project(view.rig.camera);
      const { left, top, width, height } = byId('view').getBoundingClientRect();
      return at.z > 1 ? null : [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
    },
    /** Colour of a pixel of the canvas. */
    pixel: (x: number, y: number) => {
      view.drawNow();
      const ratio = view.stage.pixelRatio;
      return Array.from(view.stage.read(Math.floor(x * ratio), Math.floor(y * ratio), 1, 1));
    },
    /** Colours of an even grid of `columns` x `rows` pixels of the canvas. */
    pixels: (columns: number, rows: number) => {
      view.drawNow();
      const { x: width, y: height } = view.stage.pixels;
      const all = view.stage.read(0, 0, width, height);
      const found: number[][] = [];
      for (let j = 0; j < rows; ++j)
        for (let i = 0; i < columns; ++i) {
          const x = Math.floor(((i + 0.5) * width) / columns);
          const y = height - 1 - Math.floor(((j + 0.5) * height) / rows);
          found.push(Array.from(all.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)));
        }
      return found;
    },
  };
}
