// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Adds files that the user drops or chooses as layers. The files are not uploaded.

import { byId, make } from '../panels/dom';
import { showToast } from '../panels/notices';
import { Layer } from '../picture/layer';
import { NodeTable } from '../picture/node_table';
import type { SceneView } from '../picture/scene_view';
import type { Vec3 } from '../server/protocol';
import { makeLocalTree } from './local_tree';
import { parsePly } from './ply_file';

/** Larger than any layer id of the server. */
const kFirstId = 1_000_000;
const kMaxBytes = 2_000_000_000;
/** Maximum distance from the scene: floats are too coarse for farther layers. */
const kMaxDistanceM = 100_000;

export class DroppedFiles {
  private nextId = kFirstId;
  private readonly chooser = make('input', { type: 'file', accept: '.ply', multiple: true });

  constructor(
    private readonly view: SceneView,
    private readonly origin_m: Vec3,
    private readonly added: () => void,
  ) {
    this.chooser.onchange = () => {
      void this.addAll([...(this.chooser.files ?? [])]);
      this.chooser.value = '';
    };
    const stage = byId('stage');
    stage.addEventListener('dragover', (event) => {
      event.preventDefault();
      stage.classList.add('dropping');
    });
    stage.addEventListener('dragleave', () => stage.classList.remove('dropping'));
    stage.addEventListener('drop', (event) => {
      event.preventDefault();
      stage.classList.remove('dropping');
      void this.addAll([...(event.dataTransfer?.files ?? [])]);
    });
  }

  choose() {
    this.chooser.click();
  }

  async addAll(files: File[]) {
    for (const file of files) await this.add(file);
  }

  private async add(file: File) {
    try {
      if (file.size > kMaxBytes) throw new Error("larger than 2 GB; pass it to 'adasplats view'");
      const points = parsePly(await file.arrayBuffer());
      if (points.count === 0) throw new Error('no points');
      const tree = makeLocalTree(points, file.name, this.nextId++, this.origin_m);
      if (Math.max(...tree.info.box.flat().map(Math.abs)) > kMaxDistanceM)
        throw new Error('more than 100 km from the scene');
      const table = NodeTable.of(tree.nodes);
      this.view.set.add(new Layer(tree.info, table, this.view.shared, tree.bytes));
      this.view.moved();
      this.added();
    } catch (error) {
      showToast(`${file.name}: ${(error as Error).message}`);
    }
  }
}
