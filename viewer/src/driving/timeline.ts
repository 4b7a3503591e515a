// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Playback time of a recording: the sensor pose and the scan at a time, and the playback speed.

import { Vector3 } from 'three';
import { poseOf, rotationOf } from './pose';
import type { Pose, SceneInfo } from '../server/protocol';

interface TrackScan {
  /** Index among all recorded scans of the scene. */
  index: number;
  time_s: number;
}

/** A trajectory that can be played, with its recorded scans if it has any. */
export interface Track {
  name: string;
  poses: Pose[];
  /** Times of the poses: from 0, ascending. */
  times_s: number[];
  scans: TrackScan[];
  /** World time at its start. */
  begin_s: number;
}

/** Trajectories of more than one pose; without any, the motion of the objects. */
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

/** For a world without a trajectory: the period in which its objects move. */
function objectTracks({ objects }: SceneInfo): Track[] {
  const times = objects.flatMap((o) => o.times_s);
  const begin_s = Math.min(...times);
  const duration_s = Math.max(...times) - begin_s;
  if (!(duration_s > 0)) return [];
  return [{ name: 'objects', poses: [], times_s: [0, duration_s], scans: [], begin_s }];
}

/** Index of the last of ascending times that is not after `time`; 0 if all are later. */
function indexAt(times: number[], time: number): number {
  let [low, high] = [0, times.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

/** Interpolates poses: linear in position, spherical (shortest arc) in rotation. */
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

  /** World time. */
  get world_s(): number {
    return this.track.begin_s + this.time_s;
  }

  /** Null: the track has no sensor poses. */
  get pose(): Pose | null {
    const { poses, times_s } = this.track;
    return poses.length > 0 ? poseAt(poses, times_s, this.time_s) : null;
  }

  /** Number within the track of the last scan before the current time; -1 without scans. */
  get scanNumber(): number {
    const { scans } = this.track;
    if (scans.length === 0) return -1;
    // Times are rounded: a scan counts from half a millisecond before its own time.
    return indexAt(
      scans.map((s) => s.time_s),
      this.time_s + 5e-4,
    );
  }

  /** At the end, starts from the beginning. */
  play() {
    if (this.time_s >= this.duration_s) this.time_s = 0;
    this.playing = true;
  }

  seek(time_s: number) {
    this.time_s = Math.min(Math.max(time_s, 0), this.duration_s);
  }

  /** Stops and moves to the next or previous scan, or pose if there are no scans. */
  stepBy(direction: 1 | -1) {
    this.playing = false;
    const { scans, times_s } = this.track;
    const stops = scans.length > 0 ? scans.map((s) => s.time_s) : times_s;
    const at = indexAt(stops, this.time_s + 5e-4);
    const back = this.time_s > stops[at] + 5e-4 ? at : at - 1;
    this.seek(stops[Math.min(Math.max(direction > 0 ? at + 1 : back, 0), stops.length - 1)]);
  }

  /** Called in each frame. Returns whether time advanced. */
  step(dt: number): boolean {
    if (!this.playing) return false;
    this.seek(this.time_s + dt * this.speed);
    if (this.time_s >= this.duration_s) this.playing = false;
    return true;
  }
}
