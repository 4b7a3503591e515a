// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Chooses the LiDAR and its parameters, and starts or pauses it.

import { button, dropdown, fill, grouped, make, checkbox } from './dom';
import type { SensorInfo, SensorMessage, Settings } from '../server/protocol';

interface Field {
  key: string;
  text: string;
  unit: string;
  low: number;
  high: number;
  step: number;
  help: string;
  /** Independent of the sensor, so it is kept when the sensor changes. */
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
    help: 'Standard deviation of the range noise',
  },
  {
    key: 'rotation_hz',
    text: 'Rotation',
    unit: 'Hz',
    low: 0.5,
    high: 50,
    step: 0.5,
    help: 'Revolutions per second',
  },
  {
    key: 'min_range_m',
    text: 'Minimum range',
    unit: 'm',
    low: 0,
    high: 100,
    step: 0.1,
    help: 'Closer returns are suppressed',
  },
  {
    key: 'max_range_m',
    text: 'Maximum range',
    unit: 'm',
    low: 1,
    high: 1000,
    step: 1,
    help: 'Farther returns are suppressed',
  },
  {
    key: 'sub_rays',
    text: 'Rays per beam',
    unit: '',
    low: 1,
    high: 19,
    step: 1,
    help: 'Rays across the cross-section of a beam',
    general: true,
  },
  {
    key: 'returns',
    text: 'Returns',
    unit: '',
    low: 1,
    high: 3,
    step: 1,
    help: 'Maximum returns per firing',
  },
  {
    key: 'rain_mm_h',
    text: 'Rain',
    unit: 'mm/h',
    low: 0,
    high: 200,
    step: 1,
    help: 'Rainfall rate',
    general: true,
  },
  {
    key: 'fog_visibility_m',
    text: 'Fog, visibility',
    unit: 'm',
    low: 0,
    high: 10000,
    step: 10,
    help: 'Visibility in the fog; empty: no fog',
    general: true,
  },
  {
    key: 'snow_mm_h',
    text: 'Snow',
    unit: 'mm/h',
    low: 0,
    high: 50,
    step: 0.5,
    help: 'Snowfall rate, as water equivalent',
    general: true,
  },
];
const kSwitches = [
  { key: 'noise', text: 'Noise', help: 'Sensor noise on ranges and angles' },
  { key: 'rolling_shutter', text: 'Rolling shutter', help: 'Sensor motion during a revolution' },
];
const kGeneral = new Set([
  ...kSwitches.map((s) => s.key),
  ...kFields.filter((f) => f.general).map((f) => f.key),
]);

/** Whether two values of a setting are equivalent; null and 0 both mean none. */
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
  /** The server's settings; null before its first answer. */
  confirmed: SensorMessage | null = null;
  /** Settings changed by the user, and those of them that the server last accepted. */
  private changed: Settings = {};
  private accepted: { name: string; settings: Settings } | null = null;
  /** Whether a request has not been answered yet. */
  private isPending = false;
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
    this.select = dropdown('LiDAR', options, chosen, (name) => this.chooseSensor(name));
    this.select.id = 'sensor';
    this.runButton = button('', 'Start or pause scanning (R)', () =>
      this.setRunning(!this.running),
    );
    this.runButton.id = 'run';
    this.runButton.className = 'primary';
    const reset = button('Reset', "Restore the sensor's own parameters", () => this.reset());
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
    this.send();
  }

  /** Sends the chosen sensor and settings to the server. */
  send() {
    this.isPending = true;
    this.events.choose(this.name, { ...this.changed });
  }

  set(key: string, value: number | boolean | null) {
    if (value === null) delete this.changed[key];
    else this.changed[key] = value;
    this.send();
  }

  /** The server's answer; answers to earlier requests do not change the fields. */
  confirm(message: SensorMessage) {
    this.confirmed = message;
    if (this.isPending && !this.isAnswer(message)) return;
    this.isPending = false;
    this.accepted = { name: message.name, settings: { ...this.changed } };
    this.name = this.select.value = message.name;
    this.showSettings(message);
  }

  /** The server rejected the request: restores the fields. */
  reject() {
    if (!this.isPending || !this.confirmed) return;
    this.isPending = false;
    const { name } = this.confirmed;
    this.changed = this.accepted?.name === name ? { ...this.accepted.settings } : {};
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
    this.send();
  }

  private showRunning() {
    this.runButton.textContent = this.running ? 'Pause' : 'Run';
    this.runButton.ariaPressed = String(this.running);
  }

  private showSettings({ rings, rays, columns, settings }: SensorMessage) {
    const image = `${rings} rings × ${grouped(columns)} columns`;
    this.facts.textContent = `${image}, ${grouped(rays)} rays per scan`;
    for (const [key, input] of this.inputs) {
      const value = settings[key];
      input.parentElement?.classList.toggle('changed', key in this.changed);
      if (input.type === 'checkbox') input.checked = value === true;
      else if (document.activeElement !== input || !(key in this.changed))
        input.value = typeof value === 'number' ? String(Number(value.toPrecision(5))) : '';
    }
  }

  private makeSwitch({ key, text, help }: (typeof kSwitches)[number]): HTMLElement {
    const label = checkbox(text, false, (on) => this.set(key, on));
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
