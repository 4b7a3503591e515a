// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Edits the clipping box: with a handle on each face, or by numbers.

import { Ray, Vector3, type PerspectiveCamera, type Vector2 } from 'three';
import type { Grabbable } from '../driving/pointer';
import { button, fill, make, segments } from '../panels/dom';
import { kClipModes, type ClipMode } from '../picture/clip';
import { Marks } from '../picture/marks';
import type { SceneView } from '../picture/scene_view';
import type { Vec3 } from '../server/protocol';
import type { Tool } from './tool_box';

const kColor = 0x4de1ff;
const kHandlePixels = 12;
const kMinHalfM = 0.05;
const kNames: Record<ClipMode, string> = {
  off: 'Off',
  inside: 'Keep inside',
  outside: 'Cut out',
};
/** Half side lengths of the first box, around the sensor, m. */
const kFirstHalf = [12, 8, 4];

interface Handle {
  axis: number;
  sign: 1 | -1;
}
const kHandles: Handle[] = [0, 1, 2].flatMap((axis) => [
  { axis, sign: 1 as const },
  { axis, sign: -1 as const },
]);

/** Signed distance from `at` along `axis` of the point nearest to the ray. */
function nearestOnAxis(ray: Ray, at: Vector3, axis: Vector3): number {
  const between = at.clone().sub(ray.origin);
  const b = axis.dot(ray.direction);
  const slant = 1 - b * b;
  if (slant < 1e-6) return 0;
  return (b * between.dot(ray.direction) - between.dot(axis)) / slant;
}

export class ClipTool implements Tool, Grabbable {
  readonly name = 'Clip';
  readonly key = 'b';
  readonly help = 'Draw only the inside or the outside of a box (B)';
  readonly card = make('div');
  private readonly marks = new Marks(kColor, 11);
  private isActive = false;
  private isPlaced = false;
  private held: Handle | null = null;
  private readonly inputs: { input: HTMLInputElement; value: () => number }[] = [];
  private readonly modes: ReturnType<typeof segments>;

  constructor(
    private readonly view: SceneView,
    private readonly origin_m: Vec3,
    private readonly sensor: () => { position: Vector3; yaw_rad: number },
  ) {
    view.stage.marks.add(this.marks.object);
    this.marks.object.visible = false;
    this.modes = segments(
      'Clipping',
      kClipModes.map((value) => ({ value, text: kNames[value] })),
      view.clip.mode,
      (mode) => {
        view.clip.mode = mode as ClipMode;
        this.changed();
      },
    );
    this.modes.id = 'clip-mode';
    this.fillCard();
  }

  activate() {
    const { clip } = this.view;
    this.isActive = true;
    if (!this.isPlaced) this.placeAtSensor();
    if (clip.mode === 'off') clip.mode = 'inside';
    this.changed();
  }

  /** Hides the handles; the box keeps clipping. */
  deactivate() {
    this.isActive = false;
    this.changed();
  }

  clicked() {}

  isAt(camera: PerspectiveCamera, screen: Vector2, height_px: number): boolean {
    return this.isActive && this.handleAt(camera, screen, height_px) !== null;
  }

  highlight() {}

  grab(camera: PerspectiveCamera, screen: Vector2, height_px: number) {
    this.held = this.handleAt(camera, screen, height_px);
  }

  drag(ray: Ray) {
    if (!this.held) return;
    const { clip } = this.view;
    const { axis, sign } = this.held;
    const direction = clip.axis(axis).multiplyScalar(sign);
    const half = clip.half.getComponent(axis);
    const pulled = nearestOnAxis(ray, this.positionOf(this.held), direction);
    const next = Math.max(half + pulled / 2, kMinHalfM);
    clip.center.addScaledVector(direction, next - half);
    clip.half.setComponent(axis, next);
    this.changed();
  }

  private placeAtSensor() {
    const { position, yaw_rad } = this.sensor();
    const { clip } = this.view;
    clip.center.copy(position);
    clip.half.set(kFirstHalf[0], kFirstHalf[1], kFirstHalf[2]);
    clip.yaw_rad = yaw_rad;
    this.isPlaced = true;
  }

  private positionOf({ axis, sign }: Handle): Vector3 {
    const { clip } = this.view;
    return clip.center
      .clone()
      .addScaledVector(clip.axis(axis), sign * clip.half.getComponent(axis));
  }

  private handleAt(camera: PerspectiveCamera, screen: Vector2, height_px: number): Handle | null {
    const reach = (2 * kHandlePixels) / height_px;
    for (const handle of kHandles) {
      const seen = this.positionOf(handle).project(camera);
      if (seen.z > 1) continue;
      if (Math.hypot((seen.x - screen.x) * camera.aspect, seen.y - screen.y) < reach) return handle;
    }
    return null;
  }

  private changed() {
    const { clip } = this.view;
    clip.apply();
    this.modes.choose(clip.mode);
    this.marks.object.visible = this.isActive;
    const corner = (x: number, y: number, z: number) =>
      new Vector3(x, y, z).applyMatrix4(clip.worldFromBox());
    const ends: Vector3[] = [];
    for (const a of [-1, 1])
      for (const b of [-1, 1])
        ends.push(
          ...[corner(-1, a, b), corner(1, a, b)],
          ...[corner(a, -1, b), corner(a, 1, b)],
          ...[corner(a, b, -1), corner(a, b, 1)],
        );
    this.marks.set(ends, kHandles.map((h) => this.positionOf(h)));
    for (const { input, value } of this.inputs)
      if (document.activeElement !== input) input.value = value().toFixed(2);
    this.view.invalidateModel();
  }

  private fillCard() {
    const { clip } = this.view;
    const rows = ['x', 'y', 'z'].map((name, i) =>
      make(
        'div',
        { className: 'row' },
        make('span', { className: 'name' }, name),
        this.number(`Center ${name}`, () => clip.center.getComponent(i) + this.origin_m[i], (v) =>
          clip.center.setComponent(i, v - this.origin_m[i]),
        ),
        this.number(`Size ${name}`, () => 2 * clip.half.getComponent(i), (v) =>
          clip.half.setComponent(i, Math.max(v / 2, kMinHalfM)),
        ),
      ),
    );
    const heading = this.number(
      'Heading, degrees',
      () => (clip.yaw_rad * 180) / Math.PI,
      (v) => (clip.yaw_rad = (v * Math.PI) / 180),
    );
    fill(
      this.card,
      this.modes,
      make('p', { className: 'facts' }, 'Center (world) and size, m. Drag a dot to move its face.'),
      ...rows,
      make('div', { className: 'row' }, make('span', { className: 'name' }, 'heading °'), heading),
      make(
        'div',
        { className: 'buttons small' },
        button('To the sensor', 'Center the box on the sensor', () => {
          this.placeAtSensor();
          this.changed();
        }),
      ),
    );
  }

  private number(label: string, value: () => number, set: (v: number) => void) {
    const input = make('input', { type: 'number', ariaLabel: label, step: '0.1' });
    input.onchange = () => {
      if (Number.isFinite(input.valueAsNumber)) set(input.valueAsNumber);
      this.changed();
    };
    this.inputs.push({ input, value });
    return input;
  }
}
