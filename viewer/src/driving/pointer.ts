// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Mouse input: drags the sensor, a handle or an object, or clicks. Other gestures move the camera.

import { Raycaster, Vector2, type PerspectiveCamera, type Ray } from 'three';
import type { SceneView } from '../picture/scene_view';

/** Position of a click. */
export interface Click {
  /** On the camera's screen, -1..1. */
  screen: Vector2;
  /** Pixel of the canvas, from its lower left corner. */
  pixel: Vector2;
}

/** An object that can be dragged with the mouse. */
export interface Grabbable {
  isAt(camera: PerspectiveCamera, screen: Vector2, height_px: number): boolean;
  highlight(on: boolean): void;
  grab(camera: PerspectiveCamera, screen: Vector2, height_px: number): void;
  drag(ray: Ray): void;
}

const kClickPixels = 4;

interface Press {
  x: number;
  y: number;
  id: number;
  grabbed: Grabbable | null;
}

export class Pointer {
  private down: Press | null = null;
  private under: Grabbable | null = null;

  constructor(
    private readonly view: SceneView,
    private readonly canvas: HTMLCanvasElement,
    /** The first one under the mouse is grabbed. */
    private readonly grabbables: Grabbable[],
    private readonly clicked: (click: Click) => void,
  ) {
    // In the capture phase, before the camera's own listener: pressed() may disable that.
    canvas.addEventListener('pointerdown', (e) => this.pressed(e), true);
    canvas.addEventListener('pointermove', (e) => this.movedTo(e));
    canvas.addEventListener('pointerup', (e) => this.released(e));
    canvas.addEventListener('pointercancel', () => this.stop());
  }

  private pressed(event: PointerEvent) {
    if (event.button !== 0 || !event.isPrimary) return;
    this.canvas.focus();
    const grabbed = this.at(event);
    this.down = { x: event.clientX, y: event.clientY, id: event.pointerId, grabbed };
    if (!grabbed) return;
    const { camera } = this.view.rig;
    grabbed.grab(camera, this.screen(event), this.view.height_px);
    this.view.rig.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
  }

  private movedTo(event: PointerEvent) {
    if (!this.down) this.highlight(this.at(event));
    else if (this.down.grabbed) this.down.grabbed.drag(this.ray(event));
  }

  private released(event: PointerEvent) {
    const { down } = this;
    this.stop();
    if (!down || down.grabbed || down.id !== event.pointerId) return;
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
    this.canvas.classList.toggle('grabbing', under !== null);
    this.view.invalidate();
  }

  private at(event: PointerEvent): Grabbable | null {
    const screen = this.screen(event);
    const { camera } = this.view.rig;
    return this.grabbables.find((g) => g.isAt(camera, screen, this.view.height_px)) ?? null;
  }

  private screen(event: PointerEvent): Vector2 {
    return this.view.screenPosition(event.clientX, event.clientY);
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
