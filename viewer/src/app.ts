// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The page, composed: what the user does, what the server says, and what is shown of it meet here.

import { CameraModes } from './driving/camera_modes';
import { firstMode } from './panels/color_panel';
import { CommandDialog } from './panels/command_dialog';
import { button, byId, fill, short } from './panels/dom';
import { DrivePanel } from './panels/drive_panel';
import { DrivenSensor } from './driving/driven_sensor';
import { publishHandle } from './handle';
import { fillHelp } from './panels/help';
import { listenToKeys } from './driving/keyboard';
import { showKeyHints } from './panels/key_hints';
import { Legend } from './panels/legend';
import { LidarPanel } from './panels/lidar_panel';
import { showLiveFigures } from './panels/live_figures';
import { LiveScans } from './live_scans';
import { showToast } from './panels/notices';
import { Picker } from './driving/picker';
import { Pointer } from './driving/pointer';
import { yawOf } from './driving/pose';
import type { SceneInfo, SensorMessage } from './server/protocol';
import { RangeStrip } from './panels/range_strip';
import { ScanCloud } from './picture/scan_cloud';
import { ScanPointsPanel } from './panels/scan_points_panel';
import { SceneSource } from './scene_source';
import { SceneView } from './picture/scene_view';
import { saveScreenshot } from './panels/screenshot';
import { SidePanel } from './panels/side_panel';
import { showViewFigures } from './panels/view_figures';

const kFiguresMs = 250;

export class App {
  private readonly view: SceneView;
  private readonly source: SceneSource;
  private readonly scans: LiveScans;
  private readonly sensor: DrivenSensor;
  private readonly lidar: LidarPanel;
  private readonly cameras: CameraModes;
  private readonly drive: DrivePanel;
  private readonly panel: SidePanel;
  private readonly strip: RangeStrip;
  private readonly legend: Legend;
  private readonly scanPoints: ScanPointsPanel;
  private readonly picker: Picker;
  private readonly dialog: CommandDialog;

  constructor(scene: SceneInfo) {
    const canvas = byId<HTMLCanvasElement>('view');
    const failed = (error: unknown) => this.loadFailed(error);
    const view = (this.view = new SceneView(canvas, failed));
    this.source = new SceneSource(scene, view, {
      loaded: () => this.panel.show(this.source.scene),
      failed,
    });
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
    const recordedCloud = new ScanCloud(view.shared.classes, view.shared.maps);
    const clouds = [cloud, recordedCloud];
    this.cameras = new CameraModes(view);
    this.drive = new DrivePanel(this.source, this.cameras, this.sensor);
    this.strip = new RangeStrip(cloud, view.palette, view.maps);
    this.legend = new Legend(scene, view.maps, view.palette);
    this.picker = new Picker(view, live, clouds, scene.origin_m);
    this.dialog = new CommandDialog(this.source, this.lidar, this.sensor.driver);
    const scanPoints = new ScanPointsPanel(view, cloud, clouds, scene.can_simulate);
    this.scanPoints = scanPoints;
    this.panel = new SidePanel(
      { view, lidar: this.lidar, drive: this.drive, scanPoints, recordedCloud },
      {
        colorsChanged: () => this.colorsChanged(),
        goTo: (pose) => this.sensor.setPose(pose),
        failed,
      },
    );
    view.stage.overlay.add(recordedCloud.object, cloud.object, ...this.sensor.objects);
    byId('strip').hidden = !scene.can_simulate;
    this.fillTools();
    fillHelp(byId('help'));
    this.listen(canvas);
  }

  start() {
    const { view, lidar, sensor } = this;
    const { scene } = this.source;
    const { live, rate, cloud } = this.scans;
    view.rig.setScene(scene.middle_box);
    view.colorMode = firstMode(scene);
    sensor.moved();
    const { position, quaternion } = sensor.body.object;
    view.rig.followSensor(position, yawOf(quaternion), 0);
    this.cameras.choose('follow');
    this.showLoading();
    showKeyHints(scene.scans.length > 0);
    view.beforeFrame = (dt) => this.step(dt);
    view.start();
    window.setInterval(() => this.showFigures(), kFiguresMs);
    void this.source.show();
    if (scene.can_simulate) {
      live.setMotion(sensor.driver.motion);
      lidar.setRunning(true);
      live.connect();
    }
    publishHandle({
      view,
      live,
      driver: sensor.driver,
      lidar,
      rate,
      cloud,
      setPose: (pose) => sensor.setPose(pose),
      setCameraMode: (mode) => this.cameras.choose(mode),
      setColor: (mode) => this.panel.chooseColor(mode),
      command: () => this.dialog.command,
      poses: () => this.dialog.poses,
    });
  }

  private makeScans(): LiveScans {
    return new LiveScans(this.view, {
      connection: (connected) => {
        if (connected) this.lidar.ask();
      },
      beforeReconnect: () => this.source.readAgain(),
      sensor: (message) => this.sensorConfirmed(message),
      error: (message) => {
        this.lidar.refuse();
        showToast(message);
      },
    });
  }

  private sensorConfirmed(message: SensorMessage) {
    this.lidar.confirm(message);
    const sensor = this.source.scene.sensors.find((s) => s.name === message.name);
    const hz = message.settings.rotation_hz ?? sensor?.rotation_hz;
    if (typeof hz === 'number' && hz > 0) this.sensor.driver.pathPeriodS = 1 / hz;
  }

  private loadFailed(error: unknown) {
    // That nobody answers is said already.
    if (this.source.scene.can_simulate && !this.scans.live.connected) return;
    showToast(`Not loaded, trying again: ${(error as Error).message}`);
  }

  /** In each frame, before it is drawn. */
  private step(dt: number) {
    const { view, sensor } = this;
    sensor.step(dt);
    const { position, quaternion } = sensor.body.object;
    if (view.rig.followSensor(position, yawOf(quaternion), dt)) view.moved();
    sensor.body.fit(view.rig.camera, view.height_px);
    this.strip.step(this.scans.step());
  }

  /** Until something is seen. */
  private showLoading() {
    const { layers, name } = this.source.scene;
    const what = layers.map((l) => `${short(l.count)} ${l.kind}`).slice(0, 2);
    const note = byId('loading');
    note.textContent = `Loading ${name}: ${what.join(', ')}`;
    note.hidden = false;
    this.view.firstShown = () => (note.hidden = true);
  }

  private colorsChanged() {
    ++this.colorVersion;
    this.strip.draw();
    this.showLegend();
  }
  private colorVersion = 0;

  private showLegend() {
    const { view, scanPoints, colorVersion } = this;
    const subject = {
      layers: view.shownLayers.map((l) => l.info),
      mode: view.colorMode,
      classes: view.seenClasses,
      scan: scanPoints.subject,
    };
    this.legend.show(subject, colorVersion);
  }

  private showFigures() {
    this.panel.update();
    this.showLegend();
    showViewFigures(byId('figures'), this.view);
    showLiveFigures(byId('live'), this.scans.cloud.packet, this.scans.rate, this.lidar.running);
    this.drive.showSpeed();
    this.strip.showFacts();
  }

  private fillTools() {
    const screenshot = () => saveScreenshot(this.view, this.source.scene.name);
    const command = () => void this.dialog.show();
    fill(
      byId('tools'),
      button('Screenshot', 'Saves the picture as PNG', screenshot),
      this.source.scene.can_simulate
        ? button('Copy command line', 'What simulates this path with this LiDAR', command)
        : null,
      button('Help', 'Keys and mouse (?)', showHelp),
    );
  }

  private listen(canvas: HTMLCanvasElement) {
    const { sensor, picker } = this;
    new Pointer(this.view, canvas, sensor.body, {
      dragged: (x, y) => sensor.moveTo(x, y),
      clicked: (place) => void picker.pick(place, sensor.body.object.position),
    });
    listenToKeys({
      driver: sensor.driver,
      escape: () => picker.hide(),
      shortcut: (key) => this.shortcut(key),
    });
    canvas.addEventListener('webglcontextlost', (e) => e.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => window.location.reload());
  }

  private shortcut(key: string): boolean {
    const { lidar, view } = this;
    const { scene } = this.source;
    if (this.cameras.chooseNumber(key)) return true;
    if (key === 'r' && scene.can_simulate) lidar.setRunning(!lidar.running);
    else if (key === 'c') this.panel.nextColor();
    else if (key === 'f') view.rig.frame(scene.middle_box);
    else if (key === 'p') this.panel.fold();
    else if (key === '?') showHelp();
    else return false;
    return true;
  }
}

function showHelp() {
  byId<HTMLDialogElement>('help').showModal();
}
