// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A dialog with the command that simulates the driven path, and the file of poses that it reads.

import { button, byId, download, fill, make, short } from './dom';
import type { Driver, TimedPose } from '../driving/driver';
import type { LidarPanel } from './lidar_panel';
import type { SceneSource } from '../scene_source';
import type { Vec3 } from '../server/protocol';

const kPosesFile = 'poses.csv';

/** Quotes a word for a POSIX shell. */
function quoted(word: string): string {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`;
}

function commandLine(begin: string[], sensor: string, options: string[]): string {
  const target = ['--sensor', sensor, '--trajectory', kPosesFile];
  const words = [...begin, ...target, ...options, '-o', 'scans'];
  return words.map(quoted).join(' ');
}

/** The path in world coordinates, in the format of `adasplats simulate --trajectory`. */
function posesCsv(path: TimedPose[], origin_m: Vec3): string {
  const lines = path.map(({ time_s, pose: [x, y, z, qx, qy, qz, qw] }) => {
    const norm = Math.hypot(qx, qy, qz, qw);
    const position = [x + origin_m[0], y + origin_m[1], z + origin_m[2]];
    const rotation = [qw, qx, qy, qz].map((q) => q / norm);
    return [time_s, ...position, ...rotation].map((v) => v.toFixed(9)).join(',');
  });
  return ['time,x,y,z,qw,qx,qy,qz', ...lines, ''].join('\n');
}

export class CommandDialog {
  constructor(
    private readonly source: SceneSource,
    private readonly lidar: LidarPanel,
    private readonly driver: Driver,
  ) {}

  get command(): string {
    const { confirmed, name } = this.lidar;
    const { command } = this.source.scene;
    return commandLine(command, confirmed?.name ?? name, confirmed?.options ?? []);
  }

  get poses(): string {
    return posesCsv(this.driver.finishedPath(), this.source.scene.origin_m);
  }

  async show() {
    const { command, poses } = this;
    const count = this.driver.finishedPath().length;
    const dialog = byId<HTMLDialogElement>('command');
    const save = button(`Save ${kPosesFile}`, 'Save the poses of the driven path', () =>
      download(kPosesFile, new Blob([poses], { type: 'text/csv' })),
    );
    save.className = 'primary';
    const copied = await navigator.clipboard.writeText(command).then(
      () => true,
      () => false,
    );
    fill(
      dialog,
      make('h2', {}, copied ? 'Copied' : 'Command line'),
      make('pre', { id: 'command-text' }, command),
      make(
        'p',
        {},
        `${kPosesFile} contains the driven path: ` +
          `${short(count)} ${count === 1 ? 'pose' : 'poses'}, one per revolution.`,
      ),
      make(
        'div',
        { className: 'buttons' },
        save,
        button('Close', 'Close (Esc)', () => dialog.close()),
      ),
    );
    if (!dialog.open) dialog.showModal();
  }
}
