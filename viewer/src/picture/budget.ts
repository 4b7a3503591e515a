// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The budget of elements per picture: follows the frame time while the view moves, and is larger at
// rest.

const kMinElements = 50_000;
const kMaxElements = 6_000_000;
const kSlowMs = 45;
/** Without a GPU, the window itself takes half of the frame time. */
const kSlowSoftwareMs = 90;
/** A slow picture reduces the budget to at least this fraction. */
const kMinFactor = 0.8;
const kQuickMs = 24;
/** Budget of the first picture: few enough for any machine, including first-time setup. */
const kFirstPicture = 400_000;
const kFirstSoftware = 20_000;
/** Maximum time of a picture at rest if the page blocks until it is drawn. */
const kMaxStillMs = 2000;
/** A longer pause between frames is not caused by drawing and is ignored. */
const kIgnoredMs = 2000;

export class Budget {
  private moving: number;
  private smoothedMs = 33;
  /** Milliseconds per element; 0: not measured yet. */
  private msPerElement = 0;

  constructor(private readonly software: boolean) {
    this.moving = software ? 120_000 : 1_500_000;
  }

  /** While the camera moves. */
  get interactive(): number {
    return this.moving;
  }

  /** For the first picture. */
  get first(): number {
    return this.software ? kFirstSoftware : kFirstPicture;
  }

  /** At rest, when the picture is drawn only once. */
  get still(): number {
    const limit = this.msPerElement > 0 ? kMaxStillMs / this.msPerElement : kMaxElements;
    return Math.min(3 * this.moving, Math.max(limit, kMinElements), kMaxElements);
  }

  /** Records the time of a picture. With few elements the fixed cost dominates. */
  drawn(ms: number, elements: number) {
    const msPerElement = ms / Math.max(elements, kMinElements);
    this.msPerElement = this.msPerElement > 0 ? (this.msPerElement + msPerElement) / 2 : msPerElement;
  }

  /** Records the time between two frames; `limited`: a larger budget would be used. */
  frame(ms: number, limited: boolean) {
    if (ms > kIgnoredMs) return;
    this.smoothedMs += (ms - this.smoothedMs) * 0.25;
    const slow = this.software ? kSlowSoftwareMs : kSlowMs;
    const factor = Math.max(kMinFactor, slow / this.smoothedMs);
    if (factor < 1) this.moving = Math.max(this.moving * factor, kMinElements);
    else if (this.smoothedMs < kQuickMs && limited)
      this.moving = Math.min(this.moving * 1.05, kMaxElements);
  }
}
