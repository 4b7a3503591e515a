// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The mouse over the scene: takes what can be taken (the sensor, a handle, an object), or clicks;
// the rest is the camera's.

import { Raycaster, Vector2, type PerspectiveCamera, type Ray } from 'three';
import type { SceneView } from '../picture/scene_view';

/** Where a click was. */
export interface Place {
  /** On the camera's screen, -1..1. */
  screen: Vector2;
  /** Of the canvas, from its lower left corner. */
  pixel: Vector2;
}

/** What can be taken with the mouse. */
export interface Grabbable {
  isAt(camera: PerspectiveCamera, place: Vector2, height_px: number): boolean;
  highlight(on: boolean): void;
  grab(camera: PerspectiveCamera, place: Vector2, height_px: number): void;
  drag(ray: Ray): void;
}

const kClickPixels = 4;

interface Press {
  x: number;
  y: number;
  id: number;
  taken: Grabbable | null;
}

export class Pointer {
  private down: Press | null = null;
  private under: Grabbable | null = null;

  constructor(
    private readonly view: SceneView,
    private readonly canvas: HTMLCanvasElement,
    /** The first that is hit is taken. */
    private readonly grabbables: Grabbable[],
    private readonly clicked: (place: Place) => void,
  ) {
    // Before the camera's own listener, which then leaves what was taken alone.
    canvas.addEventListener('pointerdown', (e) => this.pressed(e), true);
    canvas.addEventListener('pointermove', (e) => this.movedTo(e));
    canvas.addEventListener('pointerup', (e) => this.released(e));
    canvas.addEventListener('pointercancel', () => this.stop());
  }

  private pressed(event: PointerEvent) {
    if (event.button !== 0 || !event.isPrimary) return;
    this.canvas.focus();
    const taken = this.at(event);
    this.down = { x: event.clientX, y: event.clientY, id: event.pointerId, taken };
    if (!taken) return;
    const { camera } = this.view.rig;
    taken.grab(camera, this.screen(event), this.view.height_px);
    this.view.rig.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
  }

  private movedTo(event: PointerEvent) {
    if (!this.down) this.highlight(this.at(event));
    else if (this.down.taken) this.down.taken.drag(this.ray(event));
  }

  private released(event: PointerEvent) {
    const { down } = this;
    this.stop();
    if (!down || down.taken || down.id !== event.pointerId) return;
    if (Math.hypot(event.clientX - down.x, event.clientY - down.y) >= kClickPixels) return;
    this.clicked({ screen: this.screen(event), pixel: this.pixel(event) });
  }

  private stop() {
    this.down = null;
    this.view.rig.controls.enabled = true;
  }

  private highlight(under: Grabbable | null) {
    if (under === this.under) return;
    this.under?.highlight(false);
    under?.highlight(true);
    this.under = under;
    this.canvas.classList.toggle('taking', under !== null);
    this.view.invalidate();
  }

  private at(event: PointerEvent): Grabbable | null {
    const place = this.screen(event);
    const { camera } = this.view.rig;
    return this.grabbables.find((g) => g.isAt(camera, place, this.view.height_px)) ?? null;
  }

  private screen(event: PointerEvent): Vector2 {
    return this.view.screenPlace(event.clientX, event.clientY);
  }

  private pixel(event: PointerEvent): Vector2 {
    const box = this.canvas.getBoundingClientRect();
    const { x: width, y: height } = this.view.stage.pixels;
    return new Vector2(
      Math.floor(((event.clientX - box.left) / box.width) * width),
      height - 1 - Math.floor(((event.clientY - box.top) / box.height) * height),
    );
  }

  private ray(event: PointerEvent): Ray {
    const caster = new Raycaster();
    caster.setFromCamera(this.screen(event), this.view.rig.camera);
    return caster.ray;
  }
}
