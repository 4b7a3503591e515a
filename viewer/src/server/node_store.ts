// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Fetches nodes, a few at a time and the most wanted first, and tries again what failed.

export interface Fetch {
  /** Names it: what is under way is not asked for again. */
  key: string;
  load(signal: AbortSignal): Promise<ArrayBuffer>;
  arrived(bytes: ArrayBuffer): void;
}

const kAtOnce = 6;
const kFirstPauseMs = 500;
const kLongestPauseMs = 8000;

/** A queue of fetches that is replaced as a whole: what is no longer wanted is forgotten. */
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
    // Each once; what is under way comes, or is wanted again when it failed.
    const keys = new Set(this.underWay.keys());
    this.wanted = fetches.filter((f) => !keys.has(f.key) && keys.add(f.key));
    this.start();
  }

  /** Forgets everything; answers that still come are dropped. */
  clear() {
    this.wanted = [];
    for (const controller of this.underWay.values()) controller.abort();
    this.underWay.clear();
    this.pauses.clear();
  }

  /** The server is back: what failed is asked for at once. */
  retry() {
    this.pauses.clear();
    this.start();
  }

  private start() {
    const now = performance.now();
    let waits = Infinity;
    for (const one of this.wanted) {
      if (this.underWay.size >= kAtOnce) return;
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
        kLongestPauseMs,
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
