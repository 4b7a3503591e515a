// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// How often scans come.

const kWindowMs = 3000;

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
    // A pause after the last one counts once it is longer than usual.
    const usual = (last - first) / (this.times.length - 1);
    return ((this.times.length - 1) * 1000) / (last - first + Math.max(0, now - last - usual));
  }

  private forget(now: number) {
    while (this.times.length > 0 && this.times[0] < now - kWindowMs) this.times.shift();
  }
}
