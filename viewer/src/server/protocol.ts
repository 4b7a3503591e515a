// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Messages of the server: types and validation. See docs/viewer_protocol.md.

const kVersion = 2;

export type Vec3 = [number, number, number];
/** x, y, z, qx, qy, qz, qw: local_from_sensor. */
export type Pose = [number, number, number, number, number, number, number];
export type Box = [Vec3, Vec3];

const kLayerKinds = ['splats', 'points', 'mesh'] as const;
export type LayerKind = (typeof kLayerKinds)[number];

export interface LayerInfo {
  id: number;
  kind: LayerKind;
  name: string;
  count: number;
  nodes: number;
  has_classes: boolean;
  has_intensities: boolean;
  has_errors: boolean;
  has_colors: boolean;
  intensity_range: [number, number];
  error_range_m: [number, number];
  /** Part of the beams with errors: 'early', 'late', 'ghosts', 'holes'; '': all, or no errors. */
  part: string;
  box: Box;
}

export interface ClassInfo {
  id: number;
  name: string;
  color: Vec3;
}

export interface SensorInfo {
  name: string;
  title: string;
  rings: number;
  rays: number;
  rotation_hz: number;
  min_range_m: number;
  max_range_m: number;
}

interface RecordedScan {
  name: string;
  trajectory: number;
  pose: Pose;
  /** Time since the first scan of its trajectory. */
  time_s: number;
  /** Null: unknown. */
  points: number | null;
}

interface TrajectoryInfo {
  name: string;
  poses: Pose[];
  /** Times of the poses since the first, ascending. */
  times_s: number[];
  /** World time of the first pose. */
  begin_s: number;
}

/** An object of a world file. */
export interface ObjectInfo {
  name: string;
  /** In the object's frame. */
  geometry: LayerInfo;
  /** Class of all elements; null: the classes of the geometry. */
  class_id: number | null;
  scale: number;
  /** Whether it exists only between its first and last pose. */
  only_during: boolean;
  /** world_from_object at the world times times_s. */
  poses: Pose[];
  times_s: number[];
}

export interface SceneInfo {
  name: string;
  origin_m: Vec3;
  layers: LayerInfo[];
  middle_box: Box;
  classes: ClassInfo[];
  trajectories: TrajectoryInfo[];
  scans: RecordedScan[];
  objects: ObjectInfo[];
  can_simulate: boolean;
  sensors: SensorInfo[];
  sensor: string;
  start_pose: Pose;
  device: string;
  command: string[];
}

/** Settings of a LiDAR; null: none, or the sensor's default. */
export type Settings = Record<string, number | boolean | null>;

export interface SensorMessage {
  type: 'sensor';
  name: string;
  rings: number;
  columns: number;
  rays: number;
  settings: Settings;
  options: string[];
}

export interface PickedMessage {
  type: 'picked';
  id: number;
  hit: boolean;
  range_m: number;
  primitive: number;
  position: Vec3;
  normal: Vec3;
  radius_m: number;
  class?: number;
  class_name?: string;
  intensity?: number;
}

interface ErrorMessage {
  type: 'error';
  message: string;
}

type ServerMessage = SensorMessage | PickedMessage | ErrorMessage;

/** Data that violate the protocol. */
export class ProtocolError extends Error {}

type Fields = Record<string, unknown>;

function fields(value: unknown, what: string): Fields {
  if (typeof value !== 'object' || value === null || Array.isArray(value))
    throw new ProtocolError(`${what} is not an object`);
  return value as Fields;
}

function number(value: unknown, what: string): number {
  if (typeof value !== 'number' || !Number.isFinite(value))
    throw new ProtocolError(`${what} is not a number`);
  return value;
}

function text(value: unknown, what: string): string {
  if (typeof value !== 'string') throw new ProtocolError(`${what} is not a string`);
  return value;
}

function list<T>(value: unknown, what: string, item: (v: unknown, what: string) => T): T[] {
  if (value === undefined || value === null) return [];
  if (!Array.isArray(value)) throw new ProtocolError(`${what} is not a list`);
  return value.map((v, i) => item(v, `${what}[${i}]`));
}

function numbers<T extends number[]>(value: unknown, what: string, size: number): T {
  const found = list(value, what, number);
  if (found.length !== size)
    throw new ProtocolError(`${what} has ${found.length} numbers, expected ${size}`);
  return found as T;
}

export function parsePose(value: unknown, what: string): Pose {
  const found = numbers<Pose>(value, what, 7);
  const norm = Math.hypot(found[3], found[4], found[5], found[6]);
  if (!(Math.abs(norm - 1) < 0.01)) throw new ProtocolError(`${what} is not a rotation`);
  return found;
}

function box(value: unknown, what: string): Box {
  const corners = list(value, what, (v, w) => numbers<Vec3>(v, w, 3));
  if (corners.length !== 2)
    throw new ProtocolError(`${what} has ${corners.length} corners, expected 2`);
  return corners as Box;
}

function range(value: unknown, what: string): [number, number] {
  if (value === undefined || value === null) return [0, 1];
  return numbers<[number, number]>(value, what, 2);
}

function layer(value: unknown, what: string): LayerInfo {
  const v = fields(value, what);
  const name = text(v.kind, `${what}.kind`);
  const kind = kLayerKinds.find((k) => k === name);
  if (!kind)
    throw new ProtocolError(`${what}.kind is '${name}', expected ${kLayerKinds.join(' or ')}`);
  return {
    id: number(v.id, `${what}.id`),
    kind,
    name: text(v.name, `${what}.name`),
    count: number(v.count, `${what}.count`),
    nodes: number(v.nodes, `${what}.nodes`),
    has_classes: v.has_classes === true,
    has_intensities: v.has_intensities === true,
    has_errors: v.has_errors === true,
    has_colors: v.has_colors === true,
    intensity_range: range(v.intensity_range, `${what}.intensity_range`),
    error_range_m: range(v.error_range_m, `${what}.error_range_m`),
    part: typeof v.part === 'string' ? v.part : '',
    box: box(v.box, `${what}.box`),
  };
}

function classInfo(value: unknown, what: string): ClassInfo {
  const v = fields(value, what);
  return {
    id: number(v.id, `${what}.id`),
    name: text(v.name, `${what}.name`),
    color: numbers<Vec3>(v.color, `${what}.color`, 3),
  };
}

function sensorInfo(value: unknown, what: string): SensorInfo {
  const v = fields(value, what);
  const name = text(v.name, `${what}.name`);
  return {
    name,
    title: typeof v.title === 'string' && v.title !== '' ? v.title : name,
    rings: number(v.rings, `${what}.rings`),
    rays: number(v.rays, `${what}.rays`),
    rotation_hz: number(v.rotation_hz, `${what}.rotation_hz`),
    min_range_m: number(v.min_range_m, `${what}.min_range_m`),
    max_range_m: number(v.max_range_m, `${what}.max_range_m`),
  };
}

function trajectory(value: unknown, what: string): TrajectoryInfo {
  const v = fields(value, what);
  const poses = list(v.poses, `${what}.poses`, parsePose);
  const times = list(v.times_s, `${what}.times_s`, number);
  const isValid =
    times.length === poses.length && times.every((t, i) => i === 0 || t > times[i - 1]);
  // Without valid times, assume 10 Hz, the usual rotation rate.
  const times_s = isValid ? times : poses.map((_, i) => 0.1 * i);
  const begin_s = typeof v.begin_s === 'number' ? v.begin_s : 0;
  return { name: text(v.name, `${what}.name`), poses, times_s, begin_s };
}

function recordedScan(value: unknown, what: string): RecordedScan {
  const v = fields(value, what);
  return {
    name: text(v.name, `${what}.name`),
    trajectory: number(v.trajectory, `${what}.trajectory`),
    pose: parsePose(v.pose, `${what}.pose`),
    time_s: typeof v.time_s === 'number' ? v.time_s : 0,
    points: typeof v.points === 'number' ? v.points : null,
  };
}

function objectInfo(value: unknown, what: string): ObjectInfo {
  const v = fields(value, what);
  const poses = list(v.poses, `${what}.poses`, parsePose);
  const times_s = list(v.times_s, `${what}.times_s`, number);
  if (poses.length === 0 || times_s.length !== poses.length)
    throw new ProtocolError(`${what} has ${poses.length} poses at ${times_s.length} times`);
  return {
    name: text(v.name, `${what}.name`),
    geometry: layer(v.geometry, `${what}.geometry`),
    class_id: typeof v.class_id === 'number' ? v.class_id : null,
    scale: number(v.scale, `${what}.scale`),
    only_during: v.only_during === true,
    poses,
    times_s,
  };
}

/** Parses scene.json. Errors: ProtocolError. */
export function parseScene(value: unknown): SceneInfo {
  const v = fields(value, 'scene.json');
  if (v.version !== kVersion)
    throw new ProtocolError(`scene.json has version ${String(v.version)}, expected ${kVersion}`);
  const canSimulate = v.can_simulate === true;
  return {
    name: text(v.name, 'name'),
    origin_m: numbers<Vec3>(v.origin_m, 'origin_m', 3),
    layers: list(v.layers, 'layers', layer),
    middle_box: box(v.middle_box, 'middle_box'),
    classes: list(v.classes, 'classes', classInfo),
    trajectories: list(v.trajectories, 'trajectories', trajectory),
    scans: list(v.scans, 'scans', recordedScan),
    objects: list(v.objects, 'objects', objectInfo),
    can_simulate: canSimulate,
    sensors: list(v.sensors, 'sensors', sensorInfo),
    sensor: typeof v.sensor === 'string' ? v.sensor : '',
    start_pose: Array.isArray(v.start_pose)
      ? parsePose(v.start_pose, 'start_pose')
      : [0, 0, 0, 0, 0, 0, 1],
    device: typeof v.device === 'string' ? v.device : '',
    command: list(v.command, 'command', text),
  };
}

function settings(value: unknown): Settings {
  const found: Settings = {};
  if (value === undefined || value === null) return found;
  for (const [key, v] of Object.entries(fields(value, 'settings')))
    found[key] = typeof v === 'number' || typeof v === 'boolean' ? v : null;
  return found;
}

/** Parses a text message of the live channel; null: an unknown type. */
export function parseMessage(line: string): ServerMessage | null {
  const v = fields(JSON.parse(line), 'message');
  switch (v.type) {
    case 'sensor':
      return {
        type: 'sensor',
        name: text(v.name, 'sensor.name'),
        rings: number(v.rings, 'sensor.rings'),
        columns: number(v.columns, 'sensor.columns'),
        rays: number(v.rays, 'sensor.rays'),
        settings: settings(v.settings),
        options: list(v.options, 'sensor.options', text),
      };
    case 'picked':
      return picked(v);
    case 'error':
      return { type: 'error', message: text(v.message, 'error.message') };
    default:
      return null;
  }
}

function picked(v: Fields): PickedMessage {
  const id = number(v.id, 'picked.id');
  const miss: PickedMessage = {
    type: 'picked',
    id,
    hit: false,
    range_m: 0,
    primitive: 0,
    position: [0, 0, 0],
    normal: [0, 0, 1],
    radius_m: 0,
  };
  if (v.hit !== true) return miss;
  return {
    ...miss,
    hit: true,
    range_m: number(v.range_m, 'picked.range_m'),
    primitive: number(v.primitive, 'picked.primitive'),
    position: numbers<Vec3>(v.position, 'picked.position', 3),
    normal: numbers<Vec3>(v.normal, 'picked.normal', 3),
    radius_m: typeof v.radius_m === 'number' ? v.radius_m : 0,
    class: typeof v.class === 'number' ? v.class : undefined,
    class_name: typeof v.class_name === 'string' ? v.class_name : undefined,
    intensity: typeof v.intensity === 'number' ? v.intensity : undefined,
  };
}
