// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The side panel: one section per topic, rebuilt for each scene.

import { ColorPanel } from './color_panel';
import { byId, fill, make, checkbox } from './dom';
import type { DrivePanel } from './drive_panel';
import type { ObjectsPanel } from './objects_panel';
import { layersPanel } from './layers_panel';
import type { LidarPanel } from './lidar_panel';
import type { SceneInfo } from '../server/protocol';
import type { ScanPointsPanel } from './scan_points_panel';
import { PathsPanel } from './paths_panel';
import type { SceneView } from '../picture/scene_view';
import type { ColorMode } from '../picture/shaders';

/** Same width as in app.css. */
const kNarrow = '(max-width: 640px)';

export interface SidePanelParts {
  view: SceneView;
  lidar: LidarPanel;
  drive: DrivePanel;
  scanPoints: ScanPointsPanel;
  objects: ObjectsPanel;
}

export interface SidePanelEvents {
  colorsChanged(): void;
  addLayer(): void;
}

export class SidePanel {
  private colors: ColorPanel | null = null;
  private paths: PathsPanel | null = null;

  constructor(
    private readonly parts: SidePanelParts,
    private readonly events: SidePanelEvents,
  ) {
    byId('fold').onclick = () => this.fold();
    // On a phone the panel starts collapsed.
    if (window.matchMedia(kNarrow).matches) this.fold();
  }

  show(scene: SceneInfo) {
    const { view, lidar, drive, scanPoints, objects } = this.parts;
    this.paths?.dispose();
    this.colors = new ColorPanel(view, () => this.events.colorsChanged());
    this.paths = new PathsPanel(view, scene);
    const can = scene.can_simulate;
    scanPoints.style();
    fill(
      byId('sections'),
      section('Layers', layersPanel(view, () => this.events.addLayer())),
      section('Colour', this.colors.element),
      can ? section('LiDAR', lidar.element) : null,
      section(can ? 'Drive and camera' : 'Camera', drive.element),
      can || scene.scans.length > 0 ? section('Scan points', scanPoints.element) : null,
      this.paths.empty ? null : section('Paths', this.paths.element, false),
      scene.objects.length > 0 ? section('Objects', objects.element) : null,
      section('Drawing', drawingPanel(view), false),
    );
  }

  fold() {
    const folded = document.body.classList.toggle('folded');
    byId('fold').textContent = folded ? '›' : '‹';
    byId('fold').ariaExpanded = String(!folded);
  }

  chooseColor(mode: ColorMode) {
    this.colors?.choose(mode);
  }

  nextColor() {
    this.colors?.chooseNext();
  }

  /** Updates what depends on the loaded nodes. */
  update() {
    this.parts.objects.update();
    this.colors?.update();
  }
}

function section(title: string, content: HTMLElement, open = true): HTMLElement {
  return make('details', { open }, make('summary', {}, title), content);
}

function drawingPanel(view: SceneView): HTMLElement {
  const { stage } = view;
  const defaultOutline = stage.outline;
  return make(
    'div',
    {},
    checkbox('Darken edges', stage.outline > 0, (on) => {
      stage.outline = on ? defaultOutline : 0;
      view.invalidate();
    }),
  );
}
