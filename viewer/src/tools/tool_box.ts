// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Tools of the page, with buttons and keys. At most one is active and receives the clicks.

import type { Click } from '../driving/pointer';
import { button, byId, fill, make } from '../panels/dom';

export interface Tool {
  readonly name: string;
  readonly key: string;
  readonly help: string;
  /** Content of the tool card while the tool is active. */
  readonly card: HTMLElement;
  activate(): void;
  deactivate(): void;
  clicked(click: Click): void;
}

export class ToolBox {
  private active: Tool | null = null;
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

  get isActive(): boolean {
    return this.active !== null;
  }

  toggle(tool: Tool) {
    const next = tool === this.active ? null : tool;
    this.close();
    if (!next) return;
    this.active = next;
    this.buttons.get(next)!.ariaPressed = 'true';
    next.activate();
    fill(
      byId('tool'),
      make(
        'header',
        {},
        make('strong', {}, next.name),
        button('×', 'Close (Esc)', () => this.close()),
      ),
      next.card,
    );
    byId('tool').hidden = false;
    byId('view').classList.add('aiming');
  }

  close() {
    const { active } = this;
    if (!active) return;
    this.active = null;
    this.buttons.get(active)!.ariaPressed = 'false';
    active.deactivate();
    byId('tool').hidden = true;
    byId('view').classList.remove('aiming');
  }

  /** Passes a click to the active tool. Returns whether there is one. */
  clicked(click: Click): boolean {
    this.active?.clicked(click);
    return this.active !== null;
  }

  /** Toggles the tool with this key. Returns whether there is one. */
  key(key: string): boolean {
    const found = this.tools.find((t) => t.key === key);
    if (found) this.toggle(found);
    return found !== undefined;
  }
}
