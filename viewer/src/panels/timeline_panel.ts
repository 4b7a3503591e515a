// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The playback bar below the scene.

import {
  button,
  byId,
  dropdown,
  fill,
  icon,
  make,
  segments,
  slider,
  type IconName,
} from './dom';
import { kScanSources, type Playback, type ScanSource } from '../playback';

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];
/** Steps of the slider. */
const kSteps = 10_000;

export class TimelinePanel {
  private readonly play: HTMLButtonElement;
  private readonly timeSlider: HTMLInputElement;
  private readonly facts = make('span', { id: 'timeline-facts', className: 'facts' });
  private readonly sources: ReturnType<typeof segments>;

  constructor(
    private readonly playback: Playback,
    canSimulate: boolean,
  ) {
    const { timeline, tracks } = playback;
    this.play = iconButton('play', 'Play or pause (K)', () => this.toggle());
    this.play.id = 'play';
    this.timeSlider = slider('Time', { low: 0, high: kSteps, step: 1, value: 0 }, (value) => {
      if (timeline) this.playback.seek((value / kSteps) * timeline.duration_s);
      this.show();
    });
    this.timeSlider.id = 'time';
    const speed = dropdown(
      'Speed',
      kSpeeds.map((s) => ({ value: String(s), text: `${s} ×` })),
      '1',
      (value) => {
        if (timeline) timeline.speed = Number(value);
      },
    );
    speed.id = 'speed';
    this.sources = segments(
      'Scans to show',
      kScanSources.map((s) => ({ value: s, text: s[0].toUpperCase() + s.slice(1) })),
      playback.source,
      (source) => playback.choose(source as ScanSource),
    );
    this.sources.id = 'scan-source';
    const track = dropdown(
      'Recording',
      tracks.map((t, i) => ({ value: String(i), text: t.name })),
      '0',
      (value) => playback.chooseTrack(Number(value)),
    );
    const bar = byId('timeline');
    bar.hidden = timeline === null;
    fill(
      bar,
      iconButton('back', 'Previous scan (,)', () => this.stepBy(-1)),
      this.play,
      iconButton('forward', 'Next scan (.)', () => this.stepBy(1)),
      this.timeSlider,
      this.facts,
      speed,
      tracks.length > 1 ? track : null,
      canSimulate && playback.hasScans ? this.sources : null,
    );
    this.show();
  }

  toggle() {
    this.playback.toggle();
    this.show();
  }

  stepBy(direction: 1 | -1) {
    this.playback.stepBy(direction);
    this.show();
  }

  /** Shows the current time. */
  show() {
    const { timeline } = this.playback;
    if (!timeline) return;
    const { playing, time_s, duration_s, track, scanNumber } = timeline;
    if (this.play.ariaPressed !== String(playing)) {
      fill(this.play, icon(playing ? 'pause' : 'play'));
      this.play.ariaPressed = String(playing);
    }
    this.timeSlider.value = String(duration_s > 0 ? Math.round((time_s / duration_s) * kSteps) : 0);
    const scan = scanNumber < 0 ? '' : ` · scan ${scanNumber + 1} of ${track.scans.length}`;
    const text = `${time_s.toFixed(1)} of ${duration_s.toFixed(1)} s`;
    this.timeSlider.setAttribute('aria-valuetext', text + scan);
    this.facts.textContent = text + scan;
  }
}

function iconButton(name: IconName, title: string, clicked: () => void): HTMLButtonElement {
  const one = button('', title, clicked);
  one.ariaLabel = title;
  one.append(icon(name));
  return one;
}
