// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The tools, as buttons and keys; the one that is taken up gets the clicks.

import type { Place } from '../driving/pointer';
import { button, byId, fill, make } from '../panels/dom';
import type { Tool } from './tool';

export class ToolBox {
  private taken: Tool | null = null;
  private readonly buttons = new Map<Tool, HTMLButtonElement>();

  constructor(private readonly tools: Tool[]) {
    for (const tool of tools) {
      const one = button(tool.name, tool.help, () => this.toggle(tool));
      one.ariaPressed = 'false';
      this.buttons.set(tool, one);
    }
  }

  get elements(): HTMLElement[] {
    return [...this.buttons.values()];
  }

  get isTaken(): boolean {
    return this.taken !== null;
  }

  toggle(tool: Tool) {
    const next = tool === this.taken ? null : tool;
    this.putAll();
    if (!next) return;
    this.taken = next;
    this.buttons.get(next)!.ariaPressed = 'true';
    next.taken();
    fill(
      byId('tool'),
      make(
        'header',
        {},
        make('strong', {}, next.name),
        button('×', 'Put the tool away (Esc)', () => this.putAll()),
      ),
      next.card,
    );
    byId('tool').hidden = false;
    byId('view').classList.add('aiming');
  }

  putAll() {
    const { taken } = this;
    if (!taken) return;
    this.taken = null;
    this.buttons.get(taken)!.ariaPressed = 'false';
    taken.put();
    byId('tool').hidden = true;
    byId('view').classList.remove('aiming');
  }

  /** Whether it was for a tool. */
  clicked(place: Place): boolean {
    this.taken?.clicked(place);
    return this.taken !== null;
  }

  /** Whether it is the key of one. */
  key(key: string): boolean {
    const found = this.tools.find((t) => t.key === key);
    if (found) this.toggle(found);
    return found !== undefined;
  }
}
