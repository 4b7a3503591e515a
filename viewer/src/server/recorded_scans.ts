// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A cache of recorded scans, loaded on demand.

import { parseScan, type ScanPacket } from './binary';

const kKept = 24;

export class RecordedScans {
  /** In order of last use. */
  private readonly kept = new Map<number, Promise<ScanPacket>>();

  /** Rejects like fetch or with a ProtocolError; a failed scan can be requested again. */
  get(index: number): Promise<ScanPacket> {
    const found = this.kept.get(index) ?? this.load(index);
    this.kept.delete(index);
    this.kept.set(index, found);
    for (const oldest of this.kept.keys()) {
      if (this.kept.size <= kKept) break;
      this.kept.delete(oldest);
    }
    return found;
  }

  private load(index: number): Promise<ScanPacket> {
    const loading = (async () => {
      const reply = await fetch(`scans/${index}.bin`);
      if (!reply.ok) throw new Error(`scan ${index}: ${reply.status}`);
      return parseScan(await reply.arrayBuffer());
    })();
    loading.catch(() => this.kept.delete(index));
    return loading;
  }
}
