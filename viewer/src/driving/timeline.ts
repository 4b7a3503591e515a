// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Time along a recording: where the sensor was, which scan it took, and how fast it all goes by.

import { Vector3 } from 'three';
import { poseOf, rotationOf } from './pose';
import type { Pose, SceneInfo } from '../server/protocol';

export interface TrackScan {
  /** Among all recorded scans of the scene. */
  index: number;
  time_s: number;
}

/** What can be played: a trajectory, with its recorded scans if it has any. */
export interface Track {
  name: string;
  poses: Pose[];
  /** Of the poses, from 0 on, ascending. */
  times_s: number[];
  scans: TrackScan[];
  /** Time of the world at its begin. */
  begin_s: number;
}

/** Trajectories of more than one pose, and what moves without any. */
export function tracksOf(scene: SceneInfo): Track[] {
  const tracks = scene.trajectories.map(({ name, poses, times_s, begin_s }, number) => ({
    name,
    poses,
    times_s,
    begin_s,
    scans: scene.scans.flatMap(({ trajectory, time_s }, index) =>
      trajectory === number ? [{ index, time_s }] : [],
    ),
  }));
  const moving = tracks.filter((t) => t.poses.length > 1);
  return moving.length > 0 ? moving : objectTracks(scene);
}

/** Of a world without a path: the time in which its objects move. */
function objectTracks({ objects }: SceneInfo): Track[] {
  const times = objects.flatMap((o) => o.times_s);
  const begin_s = Math.min(...times);
  const duration_s = Math.max(...times) - begin_s;
  if (!(duration_s > 0)) return [];
  return [{ name: 'objects', poses: [], times_s: [0, duration_s], scans: [], begin_s }];
}

/** Index of the last of ascending times that is not after `time`; 0 where all are. */
export function indexAt(times: number[], time: number): number {
  let [low, high] = [0, times.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

/** Between two poses: evenly, and along the shortest arc. */
export function poseAt(poses: Pose[], times: number[], time: number): Pose {
  const i = indexAt(times, time);
  const next = Math.min(i + 1, poses.length - 1);
  const span = times[next] - times[i];
  const share = span > 0 ? Math.min(Math.max((time - times[i]) / span, 0), 1) : 0;
  const at = (p: Pose) => new Vector3(p[0], p[1], p[2]);
  const rotation = rotationOf(poses[i]).slerp(rotationOf(poses[next]), share);
  return poseOf(at(poses[i]).lerp(at(poses[next]), share), rotation);
}

export class Timeline {
  time_s = 0;
  speed = 1;
  playing = false;

  constructor(public track: Track) {}

  get duration_s(): number {
    return this.track.times_s[this.track.times_s.length - 1];
  }

  /** Of the world. */
  get world_s(): number {
    return this.track.begin_s + this.time_s;
  }

  /** Null: the track moves no sensor. */
  get pose(): Pose | null {
    const { poses, times_s } = this.track;
    return poses.length > 0 ? poseAt(poses, times_s, this.time_s) : null;
  }

  /** Number within the track of the scan that was the last to be taken; -1 without scans. */
  get scanNumber(): number {
    const { scans } = this.track;
    if (scans.length === 0) return -1;
    // Times are written with some digits: a scan counts from half a millisecond before its own.
    return indexAt(
      scans.map((s) => s.time_s),
      this.time_s + 5e-4,
    );
  }

  /** From the end it begins anew. */
  play() {
    if (this.time_s >= this.duration_s) this.time_s = 0;
    this.playing = true;
  }

  seek(time_s: number) {
    this.time_s = Math.min(Math.max(time_s, 0), this.duration_s);
  }

  /** To the next scan or pose, or the one before; stops. */
  stepBy(direction: 1 | -1) {
    this.playing = false;
    const { scans, times_s } = this.track;
    const stops = scans.length > 0 ? scans.map((s) => s.time_s) : times_s;
    const at = indexAt(stops, this.time_s + 5e-4);
    const back = this.time_s > stops[at] + 5e-4 ? at : at - 1;
    this.seek(stops[Math.min(Math.max(direction > 0 ? at + 1 : back, 0), stops.length - 1)]);
  }

  /** In each frame; whether time went on. */
  step(dt: number): boolean {
    if (!this.playing) return false;
    this.seek(this.time_s + dt * this.speed);
    if (this.time_s >= this.duration_s) this.playing = false;
    return true;
  }
}
