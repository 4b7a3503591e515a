// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Buttons that save the picture, the scan or a film, and copy the command line.

import { button, byId, download, make } from '../panels/dom';
import { showToast } from '../panels/notices';
import type { Playback } from '../playback';
import type { SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import { Film } from './film';
import { scanPly } from './scan_ply';

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
    this.filmButton = button('Film', 'Record a film of the playback, or of what you do', () =>
      this.toggleFilm(),
    );
    this.filmButton.id = 'film';
    const hasScans = scene.can_simulate || scene.scans.length > 0;
    const all = [
      button('Screenshot', 'Save the picture as PNG', () => this.savePicture()),
      hasScans
        ? button('Save scan', 'Save the visible scan as PLY in world coordinates', () =>
            this.saveScan(),
          )
        : null,
      this.filmButton,
      command
        ? button('Copy command line', 'Copy the command that simulates this path', command)
        : null,
    ];
    this.elements = [
      make('div', { className: 'group' }, ...all.filter((b): b is HTMLButtonElement => b !== null)),
    ];
  }

  /** Called in each frame; stops a film of the playback at its end. */
  step() {
    const { timeline } = this.playback;
    if (!this.film.recording) return;
    // Only drawn frames are recorded.
    this.view.invalidate();
    if (this.filmsPlayback && !timeline?.playing) this.stopFilm();
  }
  private filmsPlayback = false;

  private savePicture() {
    this.view.drawNow();
    byId<HTMLCanvasElement>('view').toBlob((blob) => {
      if (!blob) return showToast('Saving the picture failed');
      download(`${fileName(this.scene.name)}.png`, blob);
    }, 'image/png');
  }

  private saveScan() {
    const { packet } = this.playback;
    if (!packet) return showToast('No scan to save yet');
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
    this.filmsPlayback = timeline !== null;
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
