// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The mouse over the scene: takes the sensor, or clicks; the rest is the camera's.

import { Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { SceneView } from '../picture/scene_view';
import type { SensorBody } from '../picture/sensor_body';

export interface PointerEvents {
  dragged(x: number, y: number): void;
  clicked(place: Vector2): void;
}

const kClickPixels = 4;
/** Near the horizon a pixel is a kilometre. */
const kFarthestDragM = 500;

export class Pointer {
  private down: { x: number; y: number; id: number; drags: boolean } | null = null;

  constructor(
    private readonly view: SceneView,
    private readonly canvas: HTMLCanvasElement,
    private readonly sensor: SensorBody,
    private readonly events: PointerEvents,
  ) {
    // Before the camera's own listener, which then leaves the sensor alone.
    canvas.addEventListener('pointerdown', (e) => this.pressed(e), true);
    canvas.addEventListener('pointermove', (e) => this.movedTo(e));
    canvas.addEventListener('pointerup', (e) => this.released(e));
    canvas.addEventListener('pointercancel', () => this.stop());
  }

  private pressed(event: PointerEvent) {
    if (event.button !== 0 || !event.isPrimary) return;
    this.canvas.focus();
    const drags = this.onSensor(event);
    this.down = { x: event.clientX, y: event.clientY, id: event.pointerId, drags };
    if (!drags) return;
    this.view.rig.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
  }

  private movedTo(event: PointerEvent) {
    if (!this.down) this.highlight(this.onSensor(event));
    else if (this.down.drags) this.drag(event);
  }

  private released(event: PointerEvent) {
    const { down } = this;
    this.stop();
    if (!down || down.drags || down.id !== event.pointerId) return;
    if (Math.hypot(event.clientX - down.x, event.clientY - down.y) < kClickPixels)
      this.events.clicked(this.view.screenPlace(event.clientX, event.clientY));
  }

  private stop() {
    this.down = null;
    this.view.rig.controls.enabled = true;
  }

  private highlight(on: boolean) {
    if (this.canvas.classList.toggle('taking', on) === this.highlighted) return;
    this.highlighted = on;
    this.sensor.highlighted = on;
    this.view.invalidate();
  }
  private highlighted = false;

  private onSensor(event: PointerEvent): boolean {
    const place = this.view.screenPlace(event.clientX, event.clientY);
    return this.sensor.isAt(this.view.rig.camera, place, this.view.height_px);
  }

  private drag(event: PointerEvent) {
    const caster = new Raycaster();
    caster.setFromCamera(this.view.screenPlace(event.clientX, event.clientY), this.view.rig.camera);
    const at = this.sensor.object.position;
    const hit = caster.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -at.z), new Vector3());
    if (hit && hit.distanceTo(this.view.rig.camera.position) < kFarthestDragM)
      this.events.dragged(hit.x, hit.y);
  }
}
