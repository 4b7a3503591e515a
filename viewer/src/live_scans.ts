// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Scans as they come: the newest is shown, and the server told when the page is ready for more.

import { Live, type LiveEvents } from './server/live';
import { showBanner } from './panels/notices';
import type { ScanPacket } from './server/binary';
import { ScanCloud } from './picture/scan_cloud';
import { ScanRate } from './panels/scan_rate';
import type { SceneView } from './picture/scene_view';

const kAliveMs = 1500;
/** Scans a second that a page takes without having drawn them. */
const kEnoughPerSecond = 12;

export class LiveScans {
  readonly live: Live;
  readonly cloud: ScanCloud;
  readonly rate = new ScanRate();
  private newest: ScanPacket | null = null;
  private lastFrameMs = 0;
  /** Scans for which the server has not been told that the page is ready again. */
  private owed = 0;

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

  /** In each frame: shows what came since the last. Whether something did. */
  step(): boolean {
    this.lastFrameMs = performance.now();
    const scan = this.newest;
    if (!scan) return false;
    this.newest = null;
    this.cloud.set(scan);
    this.view.invalidate();
    this.payReady();
    return true;
  }

  private connection(connected: boolean) {
    showBanner(connected ? null : 'Not connected: trying again');
    document.body.classList.toggle('offline', !connected);
    this.rate.restart();
    this.owed = 0;
    if (connected) this.view.retryFetches();
  }

  private received(scan: ScanPacket) {
    const now = performance.now();
    this.rate.count(now);
    this.newest = scan;
    this.view.invalidate();
    ++this.owed;
    // A page that draws slowly need not make the LiDAR slow, nor be flooded; one that does not
    // draw at all (in the background) takes nothing.
    const slow = this.rate.perSecond(now) < kEnoughPerSecond;
    if (slow && now - this.lastFrameMs < kAliveMs) this.payReady();
  }

  private payReady() {
    for (; this.owed > 0; --this.owed) this.live.ready();
  }
}
