// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The live channel: reconnects, and sends its state to a restarted server.

import { parseScan, type ScanPacket } from './binary';
import {
  parseMessage,
  type PickedMessage,
  type Pose,
  type SensorMessage,
  type Settings,
} from './protocol';

export interface LiveEvents {
  /** Connected (the sensor must then be sent) or disconnected. */
  connection(connected: boolean): void;
  /** Before each reconnect: reads the scene again. Rejects while the server does not answer. */
  beforeReconnect(): Promise<void>;
  scan(scan: ScanPacket): void;
  sensor(message: SensorMessage): void;
  error(message: string): void;
}

const kFirstPauseMs = 150;
const kMaxPauseMs = 1000;
/** If no scan arrives for this long, 'ready' is sent again. */
const kPatienceMs = 5000;
const kPickPatienceMs = 5000;

export interface Motion {
  pose: Pose;
  velocity_m_s: [number, number, number];
  yaw_rate_rad_s: number;
  /** World time. */
  time_s: number;
}

export class Live {
  connected = false;
  private socket: WebSocket | null = null;
  private pauseMs = kFirstPauseMs;
  private motion: Motion | null = null;
  private running = false;
  private lastScanMs = 0;
  private nextPick = 1;
  private readonly placed = new Map<number, Pose | null>();
  private readonly picks = new Map<number, (found: PickedMessage | null) => void>();

  constructor(
    private readonly url: string,
    private readonly events: LiveEvents,
  ) {
    window.setInterval(() => this.resendReady(), 1000);
  }

  connect() {
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => this.opened();
    socket.onmessage = (event) => this.received(event.data as string | ArrayBuffer);
    socket.onclose = () => this.closed();
  }

  chooseSensor(name: string, settings: Settings) {
    this.send({ type: 'sensor', name, settings });
  }

  setMotion(motion: Motion) {
    this.motion = motion;
    this.send({ type: 'pose', ...motion });
  }

  /** Sets the pose of an object of the world; null: its own motion. */
  placeObject(id: number, pose: Pose | null) {
    this.placed.set(id, pose);
    this.send({ type: 'object', id, pose });
  }

  run(on: boolean) {
    this.running = on;
    this.lastScanMs = performance.now();
    this.send({ type: 'run', on });
  }

  /** Requests the next scan. */
  ready() {
    this.send({ type: 'ready' });
  }

  /** The splat that a ray hits; null if the server does not answer. */
  pick(origin: number[], direction: number[]): Promise<PickedMessage | null> {
    if (!this.connected) return Promise.resolve(null);
    const id = this.nextPick++;
    this.send({ type: 'pick', id, origin, direction });
    return new Promise((resolve) => {
      this.picks.set(id, resolve);
      window.setTimeout(() => this.answerPick(id, null), kPickPatienceMs);
    });
  }

  private answerPick(id: number, found: PickedMessage | null) {
    this.picks.get(id)?.(found);
    this.picks.delete(id);
  }

  private send(message: object) {
    if (this.connected) this.socket?.send(JSON.stringify(message));
  }

  private opened() {
    this.connected = true;
    this.pauseMs = kFirstPauseMs;
    this.events.connection(true);
    if (this.motion) this.send({ type: 'pose', ...this.motion });
    for (const [id, pose] of this.placed) this.send({ type: 'object', id, pose });
    this.run(this.running);
  }

  private closed() {
    const was = this.connected;
    this.connected = false;
    for (const id of [...this.picks.keys()]) this.answerPick(id, null);
    if (was) this.events.connection(false);
    this.scheduleReconnect();
  }

  private scheduleReconnect() {
    window.setTimeout(() => {
      this.events.beforeReconnect().then(
        () => this.connect(),
        () => this.scheduleReconnect(),
      );
    }, this.pauseMs);
    this.pauseMs = Math.min(this.pauseMs * 2, kMaxPauseMs);
  }

  private received(data: string | ArrayBuffer) {
    try {
      if (typeof data === 'string') this.receivedText(data);
      else {
        this.lastScanMs = performance.now();
        this.events.scan(parseScan(data));
      }
    } catch (error) {
      this.events.error(`Invalid data from the server: ${(error as Error).message}`);
    }
  }

  private receivedText(line: string) {
    const message = parseMessage(line);
    if (message?.type === 'sensor') this.events.sensor(message);
    else if (message?.type === 'picked') this.answerPick(message.id, message);
    else if (message?.type === 'error') this.events.error(message.message);
  }

  private resendReady() {
    if (!this.running || document.hidden) return;
    if (performance.now() - this.lastScanMs < kPatienceMs) return;
    this.lastScanMs = performance.now();
    this.ready();
  }
}
