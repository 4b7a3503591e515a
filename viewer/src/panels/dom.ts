// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Helpers that make elements of the page.

type Child = Node | string | null;

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element #${id}`);
  return found as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children.filter((c): c is Node | string => c !== null));
  return element;
}

export function fill(element: HTMLElement, ...children: Child[]) {
  element.replaceChildren(...children.filter((c): c is Node | string => c !== null));
}

/** A checkbox with its label. */
export function checkbox(
  text: Child,
  checked: boolean,
  changed: (on: boolean) => void,
): HTMLLabelElement {
  const box = make('input', { type: 'checkbox', checked });
  box.onchange = () => changed(box.checked);
  return make(
    'label',
    { className: 'tick' },
    box,
    typeof text === 'string' ? make('span', {}, text) : text,
  );
}

export function dropdown(
  label: string,
  options: { value: string; text: string; disabled?: boolean }[],
  value: string,
  changed: (value: string) => void,
): HTMLSelectElement {
  const select = make(
    'select',
    {},
    ...options.map((o) =>
      make('option', { value: o.value, textContent: o.text, disabled: o.disabled ?? false }),
    ),
  );
  select.value = value;
  select.ariaLabel = label;
  select.onchange = () => {
    // Otherwise the next driving key would change the selection.
    select.blur();
    changed(select.value);
  };
  return select;
}

/** A group of buttons, one of which is selected. */
export function segments(
  label: string,
  options: { value: string; text: string }[],
  value: string,
  changed: (value: string) => void,
): HTMLElement & { choose(value: string): void } {
  const group = make('div', { className: 'segments', role: 'radiogroup', ariaLabel: label });
  const buttons = options.map((o) => {
    const button = make('button', { type: 'button', textContent: o.text, role: 'radio' });
    button.dataset.value = o.value;
    button.onclick = () => {
      choose(o.value);
      changed(o.value);
    };
    return button;
  });
  const choose = (chosen: string) => {
    for (const b of buttons) b.ariaChecked = String(b.dataset.value === chosen);
  };
  group.append(...buttons);
  choose(value);
  return Object.assign(group, { choose });
}

export function slider(
  label: string,
  range: { low: number; high: number; step: number; value: number },
  changed: (value: number) => void,
): HTMLInputElement {
  const input = make('input', { type: 'range', ariaLabel: label });
  input.min = String(range.low);
  input.max = String(range.high);
  input.step = String(range.step);
  input.value = String(range.value);
  input.oninput = () => changed(Number(input.value));
  return input;
}

/** A list of names with their values. */
export function definitions(lines: Iterable<[string, string | Node]>): HTMLDListElement {
  return make(
    'dl',
    {},
    ...[...lines].flatMap(([name, value]) => [make('dt', {}, name), make('dd', {}, value)]),
  );
}

export function row(text: string, ...children: Child[]): HTMLElement {
  return make('div', { className: 'row' }, make('span', { className: 'name' }, text), ...children);
}

export function button(text: string, title: string, clicked: () => void): HTMLButtonElement {
  return make('button', { type: 'button', textContent: text, title, onclick: clicked });
}

/** SVG paths in a 16 x 16 box; fonts may lack these symbols. */
const kIcons = {
  play: 'M4 2l10 6-10 6z',
  pause: 'M4 2h3v12h-3zM9 2h3v12h-3z',
  back: 'M13 2v12l-8-6zM3 2h2v12h-2z',
  forward: 'M3 2v12l8-6zM11 2h2v12h-2z',
};
export type IconName = keyof typeof kIcons;

export function icon(name: IconName): SVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', kIcons[name]);
  svg.append(path);
  return svg;
}

/** Saves a file on the user's machine. */
export function download(name: string, content: Blob) {
  const url = URL.createObjectURL(content);
  make('a', { href: url, download: name }).click();
  window.setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** 1234567: "1,234,567". */
export function grouped(value: number): string {
  return Math.round(value).toLocaleString('en-US');
}

/** 1234567: "1.23 M". */
export function short(value: number): string {
  if (value >= 999_500) return `${(value / 1e6).toPrecision(3)} M`;
  if (value >= 10_000) return `${Math.round(value / 1e3)} k`;
  return grouped(value);
}
