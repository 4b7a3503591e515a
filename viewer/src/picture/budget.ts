// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// How many elements a picture may have: as many as the machine draws while things move, and more
// once they rest.

const kLeast = 50_000;
const kMost = 6_000_000;
const kSlowMs = 45;
/** Without a GPU half the frame is the window itself. */
const kSlowSoftwareMs = 90;
/** Of the budget, that a slow picture leaves. */
const kMostAtOnce = 0.8;
const kQuickMs = 24;
/** Of the first picture: what any machine draws soon, with all that is made for the first time. */
const kFirst = 400_000;
const kFirstSoftware = 20_000;
/** A picture at rest may take so long where it is waited for: nothing else is done meanwhile. */
const kMostStillMs = 2000;
/** A longer pause between frames tells about the page, not about the drawing. */
const kOddMs = 2000;

export class Budget {
  private moving: number;
  private smoothedMs = 33;
  /** Milliseconds an element; 0: not known. */
  private pace = 0;

  constructor(private readonly software: boolean) {
    this.moving = software ? 120_000 : 1_500_000;
  }

  /** While the eye moves. */
  get interactive(): number {
    return this.moving;
  }

  /** Of the first picture. */
  get first(): number {
    return this.software ? kFirstSoftware : kFirst;
  }

  /** Once it rests: such a picture is drawn once. */
  get still(): number {
    const most = this.pace > 0 ? Math.max(kMostStillMs / this.pace, kLeast) : kMost;
    return Math.min(3 * this.moving, most, kMost);
  }

  /** A picture of so many elements took so long in all. Of few it tells little. */
  drawn(ms: number, elements: number) {
    const pace = ms / Math.max(elements, kLeast);
    this.pace = this.pace > 0 ? (this.pace + pace) / 2 : pace;
  }

  /** Two pictures in a row took so long; `limited`: a larger budget would be used. */
  frame(ms: number, limited: boolean) {
    if (ms > kOddMs) return;
    this.smoothedMs += (ms - this.smoothedMs) * 0.25;
    const slow = this.software ? kSlowSoftwareMs : kSlowMs;
    const less = Math.max(kMostAtOnce, slow / this.smoothedMs);
    if (less < 1) this.moving = Math.max(this.moving * less, kLeast);
    else if (this.smoothedMs < kQuickMs && limited)
      this.moving = Math.min(this.moving * 1.05, kMost);
  }
}
