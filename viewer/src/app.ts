// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The page: what the user does, what the server says, and what is shown of it.

import { Raycaster, Vector2 } from 'three';
import type { CameraMode } from './camera_rig';
import { ColorPanel, firstMode } from './color_panel';
import { commandLine, kPosesFile, posesCsv } from './command_line';
import { button, byId, download, fill, make, row, segments, short, slider, tick } from './dom';
import { Driver, typing } from './driver';
import { publishHandle } from './handle';
import { fillHelp } from './help';
import { layersPanel } from './layers_panel';
import { LidarPanel } from './lidar_panel';
import { Live } from './live';
import { showLiveFigures } from './live_figures';
import { PathLine } from './path_line';
import { PickCard } from './pick_card';
import { Pointer } from './pointer';
import { parseScene, type Pose, type ScanPacket, type SceneInfo } from './protocol';
import { RangeImage, type ImageMode } from './range_image';
import { ScanCloud } from './scan_cloud';
import { ScanRate } from './scan_rate';
import { ScansPanel } from './scans_panel';
import { SceneView } from './scene_view';
import { SensorBody } from './sensor_body';
import { kScanModes, type ColorMode, type ScanMode } from './shaders';
import { yawOf } from './pose';

const kFiguresMs = 250;
const kToastMs = 6000;
const kImageMs = 60;
const kMotionMs = 33;
const kEchoPixels = 5;
const kAliveMs = 1500;
/** Scans a second that a page takes without having drawn them. */
const kEnoughPerSecond = 12;
const kCameras: [CameraMode, string][] = [
  ['orbit', 'Orbit'],
  ['follow', 'Follow'],
  ['top', 'Top'],
];
const kDrivenColor = 0x3aa0e6;

export class App {
  private readonly view: SceneView;
  private readonly live: Live;
  private readonly driver: Driver;
  private readonly sensor = new SensorBody();
  private readonly driven = new PathLine(kDrivenColor);
  private readonly liveCloud: ScanCloud;
  private readonly recordedCloud: ScanCloud;
  private readonly image: RangeImage;
  private readonly rate = new ScanRate();
  private readonly lidar: LidarPanel;
  private readonly card: PickCard;
  private readonly cameraButtons: ReturnType<typeof segments>;
  private readonly speed = make('span', { className: 'value', textContent: '0 km/h' });
  private colors!: ColorPanel;
  private scans!: ScansPanel;
  private sceneText: string;
  private newScan: ScanPacket | null = null;
  private imageDirty = false;
  private toastTimer = 0;
  private lastMotionMs = 0;
  private lastStepMs = 0;
  /** Scans for which the server has not been told that the page is ready again. */
  private owed = 0;
  private motionDue = false;

  constructor(private scene: SceneInfo) {
    const canvas = byId<HTMLCanvasElement>('view');
    this.sceneText = JSON.stringify(scene);
    this.view = new SceneView(canvas, (error) => this.fetchFailed(error));
    const { classes, maps } = this.view.shared;
    this.liveCloud = new ScanCloud(classes, maps);
    this.recordedCloud = new ScanCloud(classes, maps);
    this.image = new RangeImage(byId<HTMLCanvasElement>('range-image'), this.view.palette);
    this.live = this.makeLive();
    this.driver = new Driver(scene.start_pose, (origin, direction) =>
      this.live.pick(origin, direction),
    );
    this.lidar = new LidarPanel(scene.sensors, scene.sensor, {
      choose: (name, settings) => this.live.chooseSensor(name, settings),
      run: (on) => this.live.run(on),
    });
    this.card = new PickCard(byId('card'), this.view.palette, scene.origin_m);
    this.cameraButtons = segments(
      'Camera',
      kCameras.map(([value, text]) => ({ value, text })),
      'orbit',
      (mode) => this.setCamera(mode as CameraMode),
    );
    this.fillOverlay();
    this.fillTools();
    this.fillStrip();
    fillHelp(byId('help'));
    this.listen(canvas);
  }

  start() {
    const { scene, view } = this;
    view.rig.setScene(scene.middle_box);
    view.rig.frame(scene.middle_box);
    view.colorMode = firstMode(scene);
    this.placeSensor();
    view.beforeFrame = (dt) => this.step(dt);
    view.start();
    window.setInterval(() => this.showFigures(), kFiguresMs);
    void this.showScene();
    if (scene.can_simulate) {
      this.live.setMotion(this.driver.motion);
      this.lidar.setRunning(true);
      this.live.connect();
    }
    publishHandle({
      view,
      live: this.live,
      driver: this.driver,
      lidar: this.lidar,
      rate: this.rate,
      cloud: this.liveCloud,
      setPose: (pose) => this.setPose(pose),
      setCameraMode: (mode) => this.chooseCamera(mode),
      setColor: (mode) => this.colors.choose(mode),
      command: () => this.command,
      poses: () => this.poses,
    });
  }

  // What the server says.

  private makeLive(): Live {
    const url = new URL('live', window.location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    return new Live(url.href, {
      connection: (connected) => this.connection(connected),
      beforeReconnect: () => this.readSceneAgain(),
      scan: (scan) => this.received(scan),
      sensor: (message) => {
        this.lidar.confirm(message);
        const sensor = this.scene.sensors.find((s) => s.name === message.name);
        const hz = message.settings.rotation_hz ?? sensor?.rotation_hz;
        if (typeof hz === 'number' && hz > 0) this.driver.pathPeriodS = 1 / hz;
      },
      error: (message) => {
        this.lidar.refuse();
        this.toast(message);
      },
    });
  }

  private connection(connected: boolean) {
    const banner = byId('banner');
    banner.hidden = connected;
    banner.textContent = 'Not connected: trying again';
    document.body.classList.toggle('offline', !connected);
    this.rate.restart();
    this.owed = 0;
    if (!connected) return;
    this.view.retryFetches();
    this.lidar.ask();
  }

  /** A server that came back may serve another scene. */
  private async readSceneAgain() {
    const banner = byId('banner');
    banner.hidden = false;
    banner.textContent = 'Not connected: trying again';
    const reply = await fetch('scene.json');
    if (!reply.ok) throw new Error(`scene.json: ${reply.status}`);
    const scene = parseScene(await reply.json());
    const text = JSON.stringify(scene);
    if (text === this.sceneText) return;
    const own = (s: SceneInfo) => JSON.stringify([s.sensors, s.can_simulate, s.origin_m]);
    // With other sensors or another origin nothing of the page's state is worth keeping.
    if (own(scene) !== own(this.scene)) window.location.reload();
    this.scene = scene;
    this.sceneText = text;
    await this.showScene();
  }

  private async showScene() {
    const { scene, view } = this;
    document.title = `${scene.name} – adasplats`;
    byId('scene-name').textContent = scene.name;
    byId('scene-name').title = scene.name;
    byId('device').textContent = scene.device;
    try {
      await view.load(scene);
    } catch (error) {
      this.fetchFailed(error);
      window.setTimeout(() => void this.showScene(), 2000);
      return;
    }
    this.fillSections();
  }

  private received(scan: ScanPacket) {
    const now = performance.now();
    this.rate.count(now);
    this.newScan = scan;
    this.view.invalidate();
    ++this.owed;
    // A page that draws slowly need not make the LiDAR slow, nor be flooded; one that does not
    // draw at all (in the background) takes nothing.
    const slow = this.rate.perSecond(now) < kEnoughPerSecond;
    if (slow && now - this.lastStepMs < kAliveMs) this.payReady();
  }

  private fetchFailed(error: unknown) {
    if (this.scene.can_simulate && !this.live.connected) return;
    this.toast(`Not loaded, trying again: ${(error as Error).message}`);
  }

  // What the page shows.

  private fillOverlay() {
    const { overlay } = this.view.stage;
    overlay.add(
      this.driven.object,
      this.recordedCloud.object,
      this.liveCloud.object,
      this.sensor.object,
    );
    const can = this.scene.can_simulate;
    this.sensor.object.visible = this.driven.object.visible = can;
    byId('strip').hidden = !can;
  }

  private fillSections() {
    const { scene, view } = this;
    this.scans?.dispose();
    this.colors = new ColorPanel(view, scene, byId('legend'), () => this.drawImage());
    this.scans = new ScansPanel(view, scene, this.recordedCloud, {
      goTo: (pose) => this.setPose(pose),
      failed: (error) => this.fetchFailed(error),
    });
    const can = scene.can_simulate;
    const section = (title: string, content: HTMLElement, open = true) =>
      make('details', { open }, make('summary', {}, title), content);
    fill(
      byId('sections'),
      section('Model', layersPanel(view)),
      section('Colour', this.colors.element),
      can ? section('LiDAR', this.lidar.element) : null,
      section(can ? 'Drive and camera' : 'Camera', this.drivePanel()),
      can || scene.scans.length > 0 ? section('Scan points', this.scanPointsPanel()) : null,
      this.scans.empty ? null : section('Recorded', this.scans.element),
      section('Drawing', this.drawingPanel(), false),
    );
  }

  private drivePanel(): HTMLElement {
    const parts: HTMLElement[] = [this.cameraButtons];
    if (this.scene.can_simulate) {
      parts.push(
        tick('Keep the height over the ground', this.driver.followGround, (on) =>
          this.driver.setFollowGround(on),
        ),
        row('Speed', this.speed),
        make(
          'div',
          { className: 'buttons small' },
          button('Start pose', 'Back to where it began', () => this.setPose(this.scene.start_pose)),
          button('Clear path', 'The path begins here', () => {
            this.driver.clearPath();
            this.placeSensor();
          }),
        ),
      );
    }
    return make('div', {}, ...parts);
  }

  private scanPointsPanel(): HTMLElement {
    const modes = segments(
      'Colour of scan points',
      kScanModes.map((m) => ({ value: m, text: m[0].toUpperCase() + m.slice(1) })),
      this.scanMode,
      (mode) => this.setScanMode(mode as ScanMode),
    );
    const size = slider(
      'Size of scan points',
      { low: 1, high: 8, step: 0.5, value: this.scanPixels },
      (value) => {
        this.scanPixels = value;
        this.styleScans();
      },
    );
    const show = tick('Live scan', this.liveCloud.object.visible, (on) => {
      this.liveCloud.object.visible = on;
      this.view.invalidate();
    });
    this.styleScans();
    return make('div', {}, this.scene.can_simulate ? show : null, modes, row('Points', size));
  }
  private scanMode: ScanMode = 'range';
  private scanPixels = 2.5;

  private setScanMode(mode: ScanMode) {
    this.scanMode = mode;
    this.styleScans();
  }

  private styleScans() {
    for (const cloud of [this.liveCloud, this.recordedCloud]) {
      cloud.mode = this.scanMode;
      cloud.pointPixels = this.scanPixels * this.view.stage.pixelRatio;
    }
    this.view.invalidate();
  }

  private drawingPanel(): HTMLElement {
    const { stage } = this.view;
    const usual = stage.outline;
    return make(
      'div',
      {},
      tick('Darken edges', stage.outline > 0, (on) => {
        stage.outline = on ? usual : 0;
        this.view.invalidate();
      }),
    );
  }

  private fillTools() {
    const can = this.scene.can_simulate;
    fill(
      byId('tools'),
      button('Screenshot', 'Saves the picture as PNG', () => this.screenshot()),
      can
        ? button(
            'Copy command line',
            'What simulates this path with this LiDAR',
            () => void this.showCommand(),
          )
        : null,
      button('Help', 'Keys and mouse (?)', () => byId<HTMLDialogElement>('help').showModal()),
    );
  }

  private fillStrip() {
    const modes = segments(
      'Range image',
      ['range', 'class', 'intensity'].map((m) => ({
        value: m,
        text: m[0].toUpperCase() + m.slice(1),
      })),
      'range',
      (mode) => {
        this.image.mode = mode as ImageMode;
        this.drawImage();
      },
    );
    fill(
      byId('strip-bar'),
      make('strong', {}, 'Range image'),
      modes,
      make('span', { id: 'strip-facts', className: 'facts' }),
    );
  }

  private drawImage() {
    if (this.liveCloud.packet) this.image.draw(this.liveCloud.packet);
  }

  private showFigures() {
    this.colors?.update();
    const s = this.view.statistics;
    const rate = s.framesPerSecond > 0 ? `${s.framesPerSecond.toFixed(0)} frames/s` : 'at rest';
    byId('figures').textContent =
      `${short(s.elements)} of ${short(this.shownElements())} elements, ` +
      `${s.nodes} nodes${s.loading ? ' (loading)' : ''}, ${rate}`;
    showLiveFigures(byId('live'), this.liveCloud.packet, this.rate, this.lidar.running);
    this.speed.textContent = `${(3.6 * this.driver.speed_m_s).toFixed(0)} km/h`;
    const packet = this.liveCloud.packet;
    if (packet)
      byId('strip-facts').textContent =
        `${packet.rings} rings × ${packet.columns} columns, to ${packet.max_range_m.toFixed(0)} m`;
  }

  private shownElements(): number {
    return this.view.shownLayers.reduce((sum, l) => sum + l.info.count, 0);
  }

  private toast(message: string, note = false) {
    const toast = byId('toast');
    toast.textContent = message;
    toast.classList.toggle('note', note);
    toast.hidden = false;
    window.clearTimeout(this.toastTimer);
    this.toastTimer = window.setTimeout(() => (toast.hidden = true), kToastMs);
  }

  // What happens in a frame.

  private step(dt: number) {
    this.lastStepMs = performance.now();
    if (this.scene.can_simulate && this.driver.step(dt)) this.placeSensor();
    if (this.motionDue) this.tellMotion();
    const at = this.sensor.object.position;
    if (this.view.rig.followSensor(at, yawOf(this.sensor.object.quaternion), dt)) this.view.moved();
    this.sensor.fit(this.view.rig.camera, this.view.height_px);
    this.takeScan();
    if (this.imageDirty && performance.now() - this.lastImageMs > kImageMs) {
      this.imageDirty = false;
      this.lastImageMs = performance.now();
      this.drawImage();
    }
  }
  private lastImageMs = 0;

  private takeScan() {
    const scan = this.newScan;
    if (!scan) return;
    this.newScan = null;
    this.liveCloud.set(scan);
    this.imageDirty = true;
    this.view.invalidate();
    this.payReady();
  }

  private payReady() {
    for (; this.owed > 0; --this.owed) this.live.ready();
  }

  /** The sensor moved: shows it, and tells the server. */
  private placeSensor() {
    this.sensor.setPose(this.driver.pose);
    this.driven.set(this.driver.finishedPath().map((p) => p.pose));
    this.view.invalidate();
    this.motionDue = true;
  }

  private tellMotion() {
    const now = performance.now();
    if (now - this.lastMotionMs < kMotionMs) return;
    this.lastMotionMs = now;
    this.motionDue = false;
    this.live.setMotion(this.driver.motion);
  }

  // What the user does.

  private listen(canvas: HTMLCanvasElement) {
    new Pointer(this.view, canvas, this.sensor, {
      dragged: (x, y) => {
        this.driver.moveTo(x, y);
        this.placeSensor();
      },
      clicked: (place) => void this.pick(place),
    });
    window.addEventListener('keydown', (e) => this.keyDown(e));
    window.addEventListener('keyup', (e) => this.driver.keyUp(e));
    window.addEventListener('blur', () => this.driver.releaseKeys());
    byId('fold').onclick = () => this.fold();
    canvas.addEventListener('webglcontextlost', (e) => e.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => window.location.reload());
  }

  private keyDown(event: KeyboardEvent) {
    if (event.key === 'Escape') this.card.hide();
    if (this.scene.can_simulate && this.driver.keyDown(event)) event.preventDefault();
    else if (!typing(event) && !event.repeat && this.shortcut(event.key)) event.preventDefault();
  }

  private shortcut(key: string): boolean {
    const camera = kCameras[Number(key) - 1];
    if (camera) this.chooseCamera(camera[0]);
    else if (key === 'r' && this.scene.can_simulate) this.lidar.setRunning(!this.lidar.running);
    else if (key === 'c') this.nextColor();
    else if (key === 'f') this.view.rig.frame(this.scene.middle_box);
    else if (key === 'p') this.fold();
    else if (key === '?') byId<HTMLDialogElement>('help').showModal();
    else return false;
    return true;
  }

  private fold() {
    const folded = document.body.classList.toggle('folded');
    byId('fold').textContent = folded ? '›' : '‹';
    byId('fold').ariaExpanded = String(!folded);
  }

  private nextColor() {
    const options = [...(this.colors?.element.querySelector('select')?.options ?? [])].filter(
      (o) => !o.disabled,
    );
    const next = (options.findIndex((o) => o.value === this.view.colorMode) + 1) % options.length;
    if (options[next]) this.colors.choose(options[next].value as ColorMode);
  }

  private chooseCamera(mode: CameraMode) {
    this.cameraButtons.choose(mode);
    this.setCamera(mode);
  }

  private setCamera(mode: CameraMode) {
    this.view.rig.setMode(mode);
    this.view.moved();
  }

  private setPose(pose: Pose) {
    this.driver.setPose(pose);
    this.placeSensor();
  }

  private async pick(place: Vector2) {
    const { camera } = this.view.rig;
    const caster = new Raycaster();
    caster.setFromCamera(place, camera);
    const { origin, direction } = caster.ray;
    const reach = kEchoPixels;
    const echo =
      this.liveCloud.nearest(camera, place.x, place.y, this.view.height_px, reach) ??
      this.recordedCloud.nearest(camera, place.x, place.y, this.view.height_px, reach);
    const found = await this.live.pick(origin.toArray(), direction.toArray());
    // An echo behind what the ray meets is not what was clicked.
    const hidden = echo && found?.hit && echo.position.distanceTo(origin) > found.range_m + 0.5;
    this.card.show(found, hidden ? null : echo, this.sensor.object.position);
  }

  private screenshot() {
    this.view.drawNow();
    byId<HTMLCanvasElement>('view').toBlob((blob) => {
      if (!blob) return this.toast('The picture could not be made');
      download(`${this.scene.name.replace(/[^\w.-]+/g, '_')}.png`, blob);
    }, 'image/png');
  }

  private get command(): string {
    const { confirmed, name } = this.lidar;
    return commandLine(this.scene.command, confirmed?.name ?? name, confirmed?.options ?? []);
  }

  private get poses(): string {
    return posesCsv(this.driver.finishedPath(), this.scene.origin_m);
  }

  private async showCommand() {
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
