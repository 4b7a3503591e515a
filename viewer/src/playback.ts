// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Plays a recording: moves the sensor along its trajectory and shows the recorded scans, the scans
// simulated there, or both.

import type { DrivenSensor } from './driving/driven_sensor';
import { Timeline, tracksOf } from './driving/timeline';
import type { ScanPacket } from './server/binary';
import type { SceneInfo } from './server/protocol';
import { RecordedScans } from './server/recorded_scans';
import type { ScanCloud } from './picture/scan_cloud';
import type { SceneView } from './picture/scene_view';

export const kScanSources = ['simulated', 'recorded', 'both'] as const;
export type ScanSource = (typeof kScanSources)[number];

/** Number of scans to prefetch. */
const kPrefetched = 3;

export interface PlaybackParts {
  view: SceneView;
  sensor: DrivenSensor;
  live: ScanCloud;
  recorded: ScanCloud;
  failed(error: unknown): void;
  /** Called when another scan is shown. */
  shown(): void;
}

export class Playback {
  readonly tracks;
  readonly timeline: Timeline | null;
  source: ScanSource;
  private readonly scans = new RecordedScans();
  /** Index among all scans of the scene; -1: none. */
  private wanted = -1;
  private loading = false;

  constructor(
    scene: SceneInfo,
    private readonly parts: PlaybackParts,
  ) {
    this.tracks = tracksOf(scene);
    this.timeline = this.tracks.length > 0 ? new Timeline(this.tracks[0]) : null;
    this.source = scene.can_simulate || scene.scans.length === 0 ? 'simulated' : 'recorded';
  }

  /** The scan for the range image and for saving. */
  get packet(): ScanPacket | null {
    const { live, recorded } = this.parts;
    return this.source === 'recorded' ? recorded.packet : live.packet;
  }

  get hasScans(): boolean {
    return (this.timeline?.track.scans.length ?? 0) > 0;
  }

  choose(source: ScanSource) {
    this.source = source;
    const { live, recorded } = this.parts;
    live.object.visible = source !== 'recorded';
    recorded.object.visible = source !== 'simulated';
    // One plain colour distinguishes the recorded cloud from the live one.
    recorded.isPlain = source === 'both';
    this.showScan();
    this.parts.view.invalidate();
    this.parts.shown();
  }

  chooseTrack(index: number) {
    if (!this.timeline) return;
    this.timeline.track = this.tracks[index];
    this.seek(0);
  }

  seek(time_s: number) {
    this.timeline?.seek(time_s);
    this.moved();
  }

  stepBy(direction: 1 | -1) {
    this.timeline?.stepBy(direction);
    this.moved();
  }

  toggle() {
    const { timeline } = this;
    if (!timeline) return;
    if (timeline.playing) timeline.playing = false;
    else timeline.play();
  }

  /** Called in each frame. */
  step(dt: number) {
    const { timeline } = this;
    if (!timeline?.playing) return;
    if (this.parts.sensor.driver.isSteered) timeline.playing = false;
    else if (timeline.step(dt)) this.moved();
  }

  private moved() {
    const pose = this.timeline?.pose;
    if (pose) this.parts.sensor.place(pose);
    this.showScan();
  }

  private showScan() {
    const { timeline } = this;
    const number = timeline?.scanNumber ?? -1;
    if (this.source === 'simulated' || !timeline || number < 0) return;
    const { scans } = timeline.track;
    this.wanted = scans[number].index;
    void this.load();
    if (timeline.playing)
      for (const { index } of scans.slice(number + 1, number + 1 + kPrefetched))
        this.scans.get(index).catch(() => {});
  }

  /** Loads the wanted scan, then any other that was requested in the meantime. */
  private async load() {
    const { recorded, view } = this.parts;
    if (this.loading) return;
    this.loading = true;
    const { wanted } = this;
    try {
      recorded.set(await this.scans.get(wanted));
      view.invalidate();
      this.parts.shown();
    } catch (error) {
      this.parts.failed(error);
    }
    this.loading = false;
    if (wanted !== this.wanted) void this.load();
  }
}
