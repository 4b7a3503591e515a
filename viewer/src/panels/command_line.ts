// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What was driven, as a command that simulates the same and the file of poses that it reads.

import type { TimedPose } from '../driving/driver';
import type { Vec3 } from '../server/protocol';

export const kPosesFile = 'poses.csv';

/** A word as a shell takes it. */
export function quoted(word: string): string {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`;
}

export function commandLine(begin: string[], sensor: string, options: string[]): string {
  const words = [
    ...begin,
    '--sensor',
    sensor,
    '--trajectory',
    kPosesFile,
    ...options,
    '-o',
    'scans',
  ];
  return words.map(quoted).join(' ');
}

/** As `adasplats simulate --trajectory` reads it, in world coordinates. */
export function posesCsv(path: TimedPose[], origin_m: Vec3): string {
  const lines = path.map(({ time_s, pose: [x, y, z, qx, qy, qz, qw] }) => {
    const norm = Math.hypot(qx, qy, qz, qw);
    const place = [x + origin_m[0], y + origin_m[1], z + origin_m[2]];
    const turn = [qw, qx, qy, qz].map((q) => q / norm);
    return [time_s, ...place, ...turn].map((v) => v.toFixed(9)).join(',');
  });
  return ['time,x,y,z,qw,qx,qy,qz', ...lines, ''].join('\n');
}
