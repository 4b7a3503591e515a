// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Text labels at positions of the scene.

import { Vector3, type PerspectiveCamera } from 'three';
import { make } from '../panels/dom';

export interface Label {
  position: Vector3;
  text: string;
}

export class Labels {
  private readonly shown = new Map<Label, HTMLElement>();

  constructor(private readonly parent: HTMLElement) {}

  add(position: Vector3, text: string): Label {
    const label = { position, text };
    const element = make('div', { className: 'label' }, text);
    this.shown.set(label, element);
    this.parent.append(element);
    return label;
  }

  remove(label: Label) {
    this.shown.get(label)?.remove();
    this.shown.delete(label);
  }

  /** Called before each frame is drawn. */
  place(camera: PerspectiveCamera) {
    const { clientWidth, clientHeight } = this.parent;
    for (const [label, element] of this.shown) {
      const at = label.position.clone().project(camera);
      element.hidden = at.z > 1 || Math.abs(at.x) > 1.1 || Math.abs(at.y) > 1.1;
      if (element.hidden) continue;
      const x = ((at.x + 1) / 2) * clientWidth;
      const y = ((1 - at.y) / 2) * clientHeight;
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -140%)`;
      if (element.textContent !== label.text) element.textContent = label.text;
    }
  }
}
