// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What a tool of the page is: one at a time is taken up, gets the clicks, and fills a card.

import type { Place } from '../driving/pointer';

export interface Tool {
  readonly name: string;
  readonly key: string;
  readonly help: string;
  /** What its card shows while it is taken up. */
  readonly card: HTMLElement;
  taken(): void;
  put(): void;
  clicked(place: Place): void;
}
