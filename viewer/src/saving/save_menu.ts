// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What the user takes away: the picture, the scan, a film, the command.

import { button, byId, download, make } from '../panels/dom';
import { showToast } from '../panels/notices';
import type { Playback } from '../playback';
import type { SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import { Film } from './film';
import { scanPly } from './scan_ply';
import { saveScreenshot } from './screenshot';

function fileName(text: string): string {
  return text.replace(/[^\w.-]+/g, '_');
}

export class SaveMenu {
  readonly elements: HTMLElement[];
  readonly film: Film;
  private readonly filmButton: HTMLButtonElement;

  constructor(
    private readonly view: SceneView,
    private readonly scene: SceneInfo,
    private readonly playback: Playback,
    command: (() => void) | null,
  ) {
    this.film = new Film(byId<HTMLCanvasElement>('view'), {
      done: (blob) => this.filmed(blob),
      failed: (error) => showToast((error as Error).message),
    });
    this.filmButton = button('Film', 'Records a film along the path, or of what you do', () =>
      this.toggleFilm(),
    );
    this.filmButton.id = 'film';
    const hasScans = scene.can_simulate || scene.scans.length > 0;
    const all = [
      button('Screenshot', 'Saves the picture as PNG', () => saveScreenshot(view, scene.name)),
      hasScans
        ? button('Save scan', 'Saves the scan that is shown as PLY, in world coordinates', () =>
            this.saveScan(),
          )
        : null,
      this.filmButton,
      command
        ? button('Copy command line', 'What simulates this path with this LiDAR', command)
        : null,
    ];
    this.elements = [
      make('div', { className: 'group' }, ...all.filter((b): b is HTMLButtonElement => b !== null)),
    ];
  }

  /** A film along the path ends with it. */
  step() {
    const { timeline } = this.playback;
    if (!this.film.recording) return;
    // The recorder takes frames that are drawn.
    this.view.invalidate();
    if (this.played && !timeline?.playing) this.stopFilm();
  }
  private played = false;

  private saveScan() {
    const { packet } = this.playback;
    if (!packet) return showToast('There is no scan yet');
    const name = `scan_${String(packet.number).padStart(6, '0')}.ply`;
    download(name, scanPly(packet, this.scene.origin_m));
  }

  private toggleFilm() {
    if (this.film.recording) return this.stopFilm();
    try {
      this.film.start();
    } catch (error) {
      return showToast((error as Error).message);
    }
    const { timeline } = this.playback;
    this.played = timeline !== null;
    timeline?.play();
    this.filmButton.textContent = 'Stop film';
    this.filmButton.ariaPressed = 'true';
  }

  private stopFilm() {
    this.film.stop();
    if (this.playback.timeline) this.playback.timeline.playing = false;
    this.filmButton.textContent = 'Film';
    this.filmButton.ariaPressed = 'false';
  }

  private filmed(blob: Blob) {
    if (blob.size === 0) return showToast('The film is empty');
    const ending = blob.type.endsWith('mp4') ? 'mp4' : 'webm';
    download(`${fileName(this.scene.name)}.${ending}`, blob);
  }
}
