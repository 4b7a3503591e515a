// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The page: connects user input, the server and what is drawn.

import { Group } from 'three';
import { CameraModes } from './driving/camera_modes';
import { firstMode } from './panels/color_panel';
import { CommandDialog } from './panels/command_dialog';
import { button, byId, fill, make } from './panels/dom';
import { DrivePanel } from './panels/drive_panel';
import { DrivenSensor } from './driving/driven_sensor';
import { publishHandle } from './handle';
import { DroppedFiles } from './layers/dropped_files';
import { fillHelp } from './panels/help';
import { listenToKeys } from './driving/keyboard';
import { showKeyHints } from './panels/key_hints';
import { Labels } from './picture/labels';
import { Legend } from './panels/legend';
import { LidarPanel } from './panels/lidar_panel';
import { showLiveFigures, showViewFigures } from './panels/figures';
import { LiveScans } from './live_scans';
import { showLoading, showToast } from './panels/notices';
import { ObjectsPanel } from './panels/objects_panel';
import { Picker } from './driving/picker';
import { Playback } from './playback';
import { Pointer, type Grabbable } from './driving/pointer';
import { yawOf } from './driving/pose';
import type { SceneInfo, SensorMessage } from './server/protocol';
import { RangeStrip } from './panels/range_strip';
import { SaveMenu } from './saving/save_menu';
import { ScanCloud } from './picture/scan_cloud';
import { ScanPointsPanel } from './panels/scan_points_panel';
import { SceneSource } from './scene_source';
import { SceneView } from './picture/scene_view';
import { SidePanel } from './panels/side_panel';
import { TimelinePanel } from './panels/timeline_panel';
import { ToolBox } from './tools/tool_box';
import { Tools } from './tools/tools';
import { WorldObjects } from './picture/world_objects';

const kFiguresMs = 250;
/** Maximum wait for the first picture before the LiDAR starts. */
const kPatienceMs = 3000;
/** Without a GPU: maximum wait for all visible nodes, because drawing and scans share the CPU. */
const kSoftwarePatienceMs = 10_000;

export class App {
  private readonly view: SceneView;
  private readonly source: SceneSource;
  private readonly scans: LiveScans;
  private readonly sensor: DrivenSensor;
  private readonly lidar: LidarPanel;
  private readonly cameras: CameraModes;
  private readonly drive: DrivePanel;
  private readonly panel: SidePanel;
  private readonly playback: Playback;
  private readonly timeline: TimelinePanel;
  private readonly strip: RangeStrip;
  private readonly legend: Legend;
  private readonly scanPoints: ScanPointsPanel;
  private readonly picker: Picker;
  private readonly tools: Tools;
  private readonly toolBox: ToolBox;
  private readonly labels = new Labels(byId('labels'));
  private readonly dialog: CommandDialog;
  private readonly saving: SaveMenu;
  private readonly objects: WorldObjects;
  private readonly files: DroppedFiles;
  private readonly scanPictures = new Group();
  private colorVersion = 0;

  constructor(scene: SceneInfo) {
    const canvas = byId<HTMLCanvasElement>('view');
    const failed = (error: unknown) => this.loadFailed(error);
    const view = (this.view = new SceneView(canvas, failed));
    if (scene.layers.length > 0) view.prepare(scene.layers[0]);
    this.source = new SceneSource(scene, view, { loaded: () => this.loaded(), failed });
    this.scans = this.makeScans();
    const { live, cloud } = this.scans;
    this.sensor = new DrivenSensor(
      view,
      scene,
      (origin, direction) => live.pick(origin, direction),
      (motion) => live.setMotion(motion),
    );
    this.lidar = new LidarPanel(scene.sensors, scene.sensor, {
      choose: (name, settings) => live.chooseSensor(name, settings),
      run: (on) => live.run(on),
    });
    const recorded = new ScanCloud(view.shared);
    const clouds = [cloud, recorded];
    this.objects = new WorldObjects(view, {
      placed: (index, pose) => live.placeObject(index, pose),
      failed,
    });
    this.playback = new Playback(scene, {
      view,
      sensor: this.sensor,
      live: cloud,
      recorded,
      failed,
      shown: () => this.strip.renew(),
    });
    this.timeline = new TimelinePanel(this.playback, scene.can_simulate);
    this.cameras = new CameraModes(view);
    this.drive = new DrivePanel(this.source, this.cameras, this.sensor);
    this.strip = new RangeStrip(() => this.playback.packet, view.palette, view.maps);
    this.legend = new Legend(scene, view.maps, view.palette);
    this.picker = new Picker(view, live, clouds, scene.origin_m);
    this.tools = new Tools(view, live, clouds, this.labels, this.sensor, scene.origin_m, failed);
    this.toolBox = new ToolBox(this.tools.all);
    this.dialog = new CommandDialog(this.source, this.lidar, this.sensor.driver);
    this.scanPoints = new ScanPointsPanel(view, cloud, clouds, scene.can_simulate);
    const command = scene.can_simulate ? () => void this.dialog.show() : null;
    this.saving = new SaveMenu(view, scene, this.playback, command);
    this.files = new DroppedFiles(view, scene.origin_m, () => this.loaded());
    this.panel = this.makePanel();
    this.scanPictures.add(recorded.object, cloud.object);
    view.stage.overlay.add(this.scanPictures, this.objects.object);
    view.stage.overlay.add(...this.sensor.objects);
    byId('strip').hidden = !scene.can_simulate && scene.scans.length === 0;
    fillHelp(byId('help'));
    this.fillTools();
    this.listen(canvas);
  }

  start() {
    const { view, lidar, sensor } = this;
    const { scene } = this.source;
    const { live } = this.scans;
    view.rig.setScene(scene.middle_box);
    view.colorMode = firstMode(scene);
    sensor.moved();
    const { position, quaternion } = sensor.body.object;
    view.rig.followSensor(position, yawOf(quaternion), 0);
    this.cameras.choose('follow');
    this.playback.choose(this.playback.source);
    showLoading(view, scene);
    showKeyHints(this.playback.timeline !== null);
    view.beforeFrame = (dt) => this.step(dt);
    view.start();
    window.setInterval(() => this.showFigures(), kFiguresMs);
    void this.source.show();
    void this.objects.load(scene);
    if (scene.can_simulate) {
      live.setMotion(sensor.motion);
      live.connect();
      void this.firstPicture().then(() => lidar.setRunning(true));
    }
    publishHandle({
      ...this.scans,
      view,
      lidar,
      sensor,
      playback: this.playback,
      tools: this.tools,
      objects: this.objects,
      cameras: this.cameras,
      panel: this.panel,
      dialog: this.dialog,
    });
  }

  /** Resolves after the first picture. In a city, scans load tiles and would delay it. */
  private async firstPicture() {
    const { view } = this;
    const shown = new Promise<void>((done) => {
      const before = view.firstShown;
      view.firstShown = () => {
        before();
        done();
      };
    });
    // No first picture is drawn where the view is empty.
    const patience = new Promise((done) => window.setTimeout(done, kPatienceMs));
    await Promise.race([shown, patience]);
    const end = performance.now() + kSoftwarePatienceMs;
    while (view.stage.software && view.statistics.loading && performance.now() < end)
      await new Promise((resolve) => window.setTimeout(resolve, kFiguresMs));
  }

  private makePanel(): SidePanel {
    const { view, lidar, drive, scanPoints } = this;
    const objects = new ObjectsPanel(this.objects, this.source.scene.origin_m);
    return new SidePanel(
      { view, lidar, drive, scanPoints, objects },
      { colorsChanged: () => this.colorsChanged(), addLayer: () => this.files.choose() },
    );
  }

  private makeScans(): LiveScans {
    return new LiveScans(this.view, {
      connection: (connected) => {
        if (connected) this.lidar.send();
      },
      beforeReconnect: () => this.source.readAgain(),
      sensor: (message) => this.sensorConfirmed(message),
      error: (message) => {
        this.lidar.reject();
        showToast(message);
      },
    });
  }

  private loaded() {
    this.panel.show(this.source.scene);
  }

  private sensorConfirmed(message: SensorMessage) {
    this.lidar.confirm(message);
    const sensor = this.source.scene.sensors.find((s) => s.name === message.name);
    const hz = message.settings.rotation_hz ?? sensor?.rotation_hz;
    if (typeof hz === 'number' && hz > 0) this.sensor.driver.pathPeriodS = 1 / hz;
  }

  private loadFailed(error: unknown) {
    // The banner already reports a lost connection.
    if (this.source.scene.can_simulate && !this.scans.live.connected) return;
    showToast(`Loading failed, retrying: ${(error as Error).message}`);
  }

  /** Called before each frame is drawn. */
  private step(dt: number) {
    const { view, sensor, playback } = this;
    playback.step(dt);
    sensor.step(dt);
    if (playback.timeline) {
      sensor.setTime(playback.timeline.world_s);
      this.objects.step(playback.timeline.world_s);
    }
    const { position, quaternion } = sensor.body.object;
    if (view.rig.followSensor(position, yawOf(quaternion), dt)) view.moved();
    sensor.body.fit(view.rig.camera, view.height_px);
    this.strip.step(this.scans.step());
    this.saving.step();
    this.labels.place(view.rig.camera);
  }

  private colorsChanged() {
    ++this.colorVersion;
    // Scans would cover the errors.
    this.scanPictures.visible = this.view.colorMode !== 'error';
    this.strip.draw();
    this.showLegend();
  }

  private showLegend() {
    const { view, scanPoints, colorVersion } = this;
    const subject = {
      layers: view.shownLayers.map((l) => l.info),
      mode: view.colorMode,
      classes: view.seenClasses,
      scan: scanPoints.subject,
      both: this.playback.source === 'both',
    };
    this.legend.show(subject, colorVersion);
  }

  private showFigures() {
    const { packet, source } = this.playback;
    this.panel.update();
    this.showLegend();
    showViewFigures(byId('figures'), this.view);
    const isLive = source !== 'recorded';
    showLiveFigures(byId('live'), isLive ? packet : null, this.scans.rate, this.lidar.running);
    this.drive.showSpeed();
    this.strip.showFacts();
    this.timeline.show();
  }

  private fillTools() {
    fill(
      byId('tools'),
      make('div', { className: 'group' }, ...this.toolBox.elements),
      ...this.saving.elements,
      button('Help', 'Keys and mouse (?)', showHelp),
    );
  }

  private listen(canvas: HTMLCanvasElement) {
    const { sensor, picker, toolBox } = this;
    // An active tool gets every click, even on objects that can be dragged.
    const unlessActive = (one: Grabbable): Grabbable => ({
      isAt: (...at) => !toolBox.isActive && one.isAt(...at),
      highlight: (on) => one.highlight(on),
      grab: (...at) => one.grab(...at),
      drag: (ray) => one.drag(ray),
    });
    const grabbables = [this.tools.clip, unlessActive(sensor.grabbable), unlessActive(this.objects)];
    new Pointer(this.view, canvas, grabbables, (click) => {
      if (!toolBox.clicked(click)) void picker.pick(click.screen, sensor.body.object.position);
    });
    listenToKeys({
      driver: sensor.driver,
      escape: () => {
        picker.hide();
        toolBox.close();
      },
      shortcut: (key) => this.shortcut(key),
    });
    canvas.addEventListener('webglcontextlost', (e) => e.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => window.location.reload());
  }

  private shortcut(key: string): boolean {
    const { lidar, view } = this;
    const { scene } = this.source;
    if (this.cameras.chooseNumber(key) || this.toolBox.key(key)) return true;
    if (key === 'r' && scene.can_simulate) lidar.setRunning(!lidar.running);
    else if (key === 'c') this.panel.nextColor();
    else if (key === 'f') view.rig.frame(scene.middle_box);
    else if (key === 'p') this.panel.fold();
    else if (key === 'k') this.timeline.toggle();
    else if (key === ',') this.timeline.stepBy(-1);
    else if (key === '.') this.timeline.stepBy(1);
    else if (key === '?') showHelp();
    else return false;
    return true;
  }
}

function showHelp() {
  byId<HTMLDialogElement>('help').showModal();
}
