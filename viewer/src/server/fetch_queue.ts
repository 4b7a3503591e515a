// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A queue of fetches: runs a few at a time, in order of priority, and retries failed ones.

export interface Fetch {
  /** Identifies the fetch; a running one is not started again. */
  key: string;
  load(signal: AbortSignal): Promise<ArrayBuffer>;
  arrived(bytes: ArrayBuffer): void;
}

const kMaxParallel = 6;
const kFirstPauseMs = 500;
const kMaxPauseMs = 8000;

/** want() replaces the queue; fetches that are no longer wanted are dropped. */
export class FetchQueue {
  private wanted: Fetch[] = [];
  private readonly underWay = new Map<string, AbortController>();
  private readonly pauses = new Map<string, { until: number; length: number }>();
  private timer = 0;

  constructor(private readonly failed: (key: string, error: unknown) => void) {}

  get busy(): boolean {
    return this.underWay.size > 0;
  }

  want(fetches: Fetch[]) {
    // Each key once, without running fetches.
    const keys = new Set(this.underWay.keys());
    this.wanted = fetches.filter((f) => !keys.has(f.key) && keys.add(f.key));
    this.start();
  }

  /** Cancels all fetches and ignores late replies. */
  clear() {
    this.wanted = [];
    for (const controller of this.underWay.values()) controller.abort();
    this.underWay.clear();
    this.pauses.clear();
  }

  /** Retries failed fetches at once, after a reconnect. */
  retry() {
    this.pauses.clear();
    this.start();
  }

  private start() {
    const now = performance.now();
    let waits = Infinity;
    for (const one of this.wanted) {
      if (this.underWay.size >= kMaxParallel) return;
      const pause = this.pauses.get(one.key);
      if (pause && pause.until > now) waits = Math.min(waits, pause.until - now);
      else void this.run(one);
    }
    window.clearTimeout(this.timer);
    if (Number.isFinite(waits)) this.timer = window.setTimeout(() => this.start(), waits + 10);
  }

  private async run(one: Fetch) {
    const controller = new AbortController();
    this.underWay.set(one.key, controller);
    this.wanted = this.wanted.filter((f) => f !== one);
    try {
      const bytes = await one.load(controller.signal);
      if (controller.signal.aborted) return;
      one.arrived(bytes);
      this.pauses.delete(one.key);
    } catch (error) {
      if (controller.signal.aborted) return;
      const length = Math.min(
        (this.pauses.get(one.key)?.length ?? kFirstPauseMs / 2) * 2,
        kMaxPauseMs,
      );
      this.pauses.set(one.key, { until: performance.now() + length, length });
      this.wanted.push(one);
      this.failed(one.key, error);
    } finally {
      if (this.underWay.get(one.key) === controller) this.underWay.delete(one.key);
    }
    this.start();
  }
}
