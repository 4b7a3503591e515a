// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The LiDAR: which, with which parameters, and whether it scans.

import { button, choice, fill, grouped, make, tick } from './dom';
import type { SensorInfo, SensorMessage, Settings } from '../server/protocol';

interface Field {
  key: string;
  text: string;
  unit: string;
  low: number;
  high: number;
  step: number;
  help: string;
  /** Means the same with every sensor, so it outlives a change of the sensor. */
  general?: boolean;
}

const kFields: Field[] = [
  {
    key: 'range_noise_m',
    text: 'Range noise',
    unit: 'm',
    low: 0,
    high: 1,
    step: 0.005,
    help: 'Standard deviation of the noise on ranges',
  },
  {
    key: 'rotation_hz',
    text: 'Rotation',
    unit: 'Hz',
    low: 0.5,
    high: 50,
    step: 0.5,
    help: 'Revolutions a second',
  },
  {
    key: 'min_range_m',
    text: 'Nearest',
    unit: 'm',
    low: 0,
    high: 100,
    step: 0.1,
    help: 'Echoes nearer than this are not told',
  },
  {
    key: 'max_range_m',
    text: 'Farthest',
    unit: 'm',
    low: 1,
    high: 1000,
    step: 1,
    help: 'Echoes farther than this are not told',
  },
  {
    key: 'sub_rays',
    text: 'Rays a beam',
    unit: '',
    low: 1,
    high: 19,
    step: 1,
    help: 'Rays over the cross-section of a beam',
    general: true,
  },
  {
    key: 'returns',
    text: 'Returns',
    unit: '',
    low: 1,
    high: 3,
    step: 1,
    help: 'Most returns of a firing',
  },
  {
    key: 'rain_mm_h',
    text: 'Rain',
    unit: 'mm/h',
    low: 0,
    high: 200,
    step: 1,
    help: 'Rate of rain',
    general: true,
  },
  {
    key: 'fog_visibility_m',
    text: 'Fog, visibility',
    unit: 'm',
    low: 0,
    high: 10000,
    step: 10,
    help: 'How far one sees in the fog; empty: no fog',
    general: true,
  },
  {
    key: 'snow_mm_h',
    text: 'Snow',
    unit: 'mm/h',
    low: 0,
    high: 50,
    step: 0.5,
    help: 'Rate of snow, as water',
    general: true,
  },
];
const kSwitches = [
  { key: 'noise', text: 'Noise', help: 'Of the sensor, on ranges and angles' },
  { key: 'rolling_shutter', text: 'Rolling shutter', help: 'The sensor moves while it turns' },
];
const kGeneral = new Set([
  ...kSwitches.map((s) => s.key),
  ...kFields.filter((f) => f.general).map((f) => f.key),
]);

/** Whether two values of a setting mean the same; null and 0 are both "none". */
function same(a: number | boolean | null, b: number | boolean | null | undefined): boolean {
  if (typeof a === 'boolean') return a === b;
  return typeof b !== 'boolean' && Math.abs((a ?? 0) - (b ?? 0)) <= 1e-6 * Math.abs(a ?? 0);
}

export interface LidarEvents {
  choose(name: string, settings: Settings): void;
  run(on: boolean): void;
}

export class LidarPanel {
  readonly element = make('div');
  name: string;
  running = false;
  /** What the server uses; null before its first answer. */
  confirmed: SensorMessage | null = null;
  /** What the user changed, and what of it the server took. */
  private changed: Settings = {};
  private taken: { name: string; settings: Settings } | null = null;
  /** What was asked for has not been answered. */
  private asked = false;
  private readonly select: HTMLSelectElement;
  private readonly facts = make('p', { className: 'facts' });
  private readonly inputs = new Map<string, HTMLInputElement>();
  private readonly runButton: HTMLButtonElement;

  constructor(
    sensors: SensorInfo[],
    chosen: string,
    private readonly events: LidarEvents,
  ) {
    this.name = chosen;
    const options = sensors.map((s) => ({ value: s.name, text: s.title }));
    if (!sensors.some((s) => s.name === chosen)) options.unshift({ value: chosen, text: chosen });
    this.select = choice('LiDAR', options, chosen, (name) => this.chooseSensor(name));
    this.select.id = 'sensor';
    this.runButton = button('', 'Scan without end, or stop (R)', () =>
      this.setRunning(!this.running),
    );
    this.runButton.id = 'run';
    this.runButton.className = 'primary';
    const reset = button('Reset', "The sensor's own parameters", () => this.reset());
    fill(
      this.element,
      this.select,
      this.facts,
      make('div', { className: 'buttons' }, this.runButton, reset),
      make('div', { className: 'ticks' }, ...kSwitches.map((s) => this.makeSwitch(s))),
      make('div', { className: 'fields' }, ...kFields.map((f) => this.makeField(f))),
    );
    this.showRunning();
  }

  setRunning(on: boolean) {
    this.running = on;
    this.showRunning();
    this.events.run(on);
  }

  chooseSensor(name: string) {
    this.name = name;
    this.select.value = name;
    this.changed = Object.fromEntries(
      Object.entries(this.changed).filter(([key]) => kGeneral.has(key)),
    );
    this.ask();
  }

  /**
   * Tells the server what was chosen. A new one tells what it begins with before it answers.
   */
  ask() {
    this.asked = true;
    this.events.choose(this.name, { ...this.changed });
  }

  set(key: string, value: number | boolean | null) {
    if (value === null) delete this.changed[key];
    else this.changed[key] = value;
    this.ask();
  }

  /** The server's answer; one to an earlier question is not the last word. */
  confirm(message: SensorMessage) {
    this.confirmed = message;
    if (this.asked && !this.isAnswer(message)) return;
    this.asked = false;
    this.taken = { name: message.name, settings: { ...this.changed } };
    this.name = this.select.value = message.name;
    this.showSettings(message);
  }

  /** The server kept what it had: so do the fields. */
  refuse() {
    if (!this.asked || !this.confirmed) return;
    this.asked = false;
    const { name } = this.confirmed;
    this.changed = this.taken?.name === name ? { ...this.taken.settings } : {};
    this.name = this.select.value = name;
    this.showSettings(this.confirmed);
  }

  private isAnswer({ name, settings }: SensorMessage): boolean {
    return (
      name === this.name && Object.entries(this.changed).every(([key, v]) => same(v, settings[key]))
    );
  }

  private reset() {
    this.changed = {};
    this.ask();
  }

  private showRunning() {
    this.runButton.textContent = this.running ? 'Pause' : 'Run';
    this.runButton.ariaPressed = String(this.running);
  }

  private showSettings({ rings, rays, columns, settings }: SensorMessage) {
    const image = `${rings} rings × ${grouped(columns)} columns`;
    this.facts.textContent = `${image}, ${grouped(rays)} rays a scan`;
    for (const [key, input] of this.inputs) {
      const value = settings[key];
      input.parentElement?.classList.toggle('changed', key in this.changed);
      if (input.type === 'checkbox') input.checked = value === true;
      else if (document.activeElement !== input || !(key in this.changed))
        input.value = typeof value === 'number' ? String(Number(value.toPrecision(5))) : '';
    }
  }

  private makeSwitch({ key, text, help }: (typeof kSwitches)[number]): HTMLElement {
    const label = tick(text, false, (on) => this.set(key, on));
    label.title = help;
    const input = label.querySelector('input') as HTMLInputElement;
    input.id = `setting-${key}`;
    this.inputs.set(key, input);
    return label;
  }

  private makeField({ key, text, unit, low, high, step, help }: Field): HTMLElement {
    const input = make('input', { type: 'number', id: `setting-${key}` });
    Object.assign(input, {
      min: String(low),
      max: String(high),
      step: String(step),
      ariaLabel: text,
    });
    input.onchange = () => {
      const value = input.valueAsNumber;
      this.set(key, Number.isFinite(value) ? value : null);
    };
    this.inputs.set(key, input);
    return make(
      'label',
      { className: 'field', title: help },
      make('span', {}, text),
      input,
      make('em', {}, unit),
    );
  }
}
