// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The command that simulates what was driven, for the user to copy.

import { commandLine, kPosesFile, posesCsv } from './command_line';
import { button, byId, download, fill, make, short } from './dom';
import type { Driver } from '../driving/driver';
import type { LidarPanel } from './lidar_panel';
import type { SceneSource } from '../scene_source';

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
    const save = button(`Save ${kPosesFile}`, 'The poses that were driven', () =>
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
        `${kPosesFile} holds the driven path: ` +
          `${short(count)} ${count === 1 ? 'pose' : 'poses'}, one a revolution.`,
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
