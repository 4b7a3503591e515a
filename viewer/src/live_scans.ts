// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Live scans: shows the newest and requests the next.

import { Live, type LiveEvents } from './server/live';
import { showBanner } from './panels/notices';
import type { ScanPacket } from './server/binary';
import { ScanCloud } from './picture/scan_cloud';
import type { SceneView } from './picture/scene_view';

const kAliveMs = 1500;
const kWindowMs = 3000;
/** Below this rate, scans are requested before the last one was drawn. */
const kSlowScansPerSecond = 12;

/** The rate of scans over the last kWindowMs. */
export class ScanRate {
  received = 0;
  private times: number[] = [];

  count(now: number) {
    ++this.received;
    this.times.push(now);
    this.forget(now);
  }

  restart() {
    this.times = [];
  }

  perSecond(now: number): number {
    this.forget(now);
    if (this.times.length < 2) return 0;
    const first = this.times[0];
    const last = this.times[this.times.length - 1];
    // A pause after the last scan counts once it is longer than usual.
    const usual = (last - first) / (this.times.length - 1);
    return ((this.times.length - 1) * 1000) / (last - first + Math.max(0, now - last - usual));
  }

  private forget(now: number) {
    while (this.times.length > 0 && this.times[0] < now - kWindowMs) this.times.shift();
  }
}

export class LiveScans {
  readonly live: Live;
  readonly cloud: ScanCloud;
  readonly rate = new ScanRate();
  private newest: ScanPacket | null = null;
  private lastFrameMs = 0;
  /** Received scans for which no 'ready' message has been sent. */
  private unanswered = 0;

  constructor(
    private readonly view: SceneView,
    events: Omit<LiveEvents, 'scan'>,
  ) {
    this.cloud = new ScanCloud(view.shared);
    const url = new URL('live', window.location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    this.live = new Live(url.href, {
      ...events,
      connection: (connected) => {
        this.connection(connected);
        events.connection(connected);
      },
      scan: (scan) => this.received(scan),
    });
  }

  /** Called in each frame: shows the newest scan. Returns whether a new one arrived. */
  step(): boolean {
    this.lastFrameMs = performance.now();
    const scan = this.newest;
    if (!scan) return false;
    this.newest = null;
    this.cloud.set(scan);
    this.view.invalidate();
    this.sendReady();
    return true;
  }

  private connection(connected: boolean) {
    showBanner(connected ? null : 'Connection lost, reconnecting');
    document.body.classList.toggle('offline', !connected);
    this.rate.restart();
    this.unanswered = 0;
    if (connected) this.view.retryFetches();
  }

  private received(scan: ScanPacket) {
    const now = performance.now();
    this.rate.count(now);
    this.newest = scan;
    this.view.invalidate();
    ++this.unanswered;
    // A slow page must not slow the LiDAR down, nor receive more scans than it can handle. A page
    // in the background, which does not draw at all, requests none.
    const slow = this.rate.perSecond(now) < kSlowScansPerSecond;
    if (slow && now - this.lastFrameMs < kAliveMs) this.sendReady();
  }

  private sendReady() {
    for (; this.unanswered > 0; --this.unanswered) this.live.ready();
  }
}
