// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The objects of a world file: drawn at their poses at a time, or where they were dragged to.

import {
  Group,
  Matrix4,
  Plane,
  Raycaster,
  Vector3,
  type PerspectiveCamera,
  type Ray,
  type Vector2,
} from 'three';
import type { Grabbable } from '../driving/pointer';
import { matrixOf } from '../driving/pose';
import { poseAt } from '../driving/timeline';
import { openLayer, type Layer } from './layer';
import type { ObjectInfo, Pose, SceneInfo } from '../server/protocol';
import type { SceneView } from './scene_view';

/** Maximum elements drawn of an object's geometry. */
const kMaxElements = 400_000;
const kMaxDragM = 500;

export interface ObjectsEvents {
  /** Called when an object was dragged; null: returned to its own motion. */
  placed(index: number, pose: Pose | null): void;
  failed(error: unknown): void;
}

class PlacedObject {
  readonly group = new Group();
  dragged: Pose | null = null;

  constructor(
    readonly info: ObjectInfo,
    readonly layer: Layer,
  ) {
    this.group.matrixAutoUpdate = false;
  }

  poseAt(world_s: number): Pose {
    const { poses, times_s } = this.info;
    return this.dragged ?? poseAt(poses, times_s, world_s);
  }

  place(world_s: number) {
    const { scale, only_during, times_s } = this.info;
    const absent = only_during && (world_s < times_s[0] || world_s > times_s[times_s.length - 1]);
    this.group.visible = this.dragged !== null || !absent;
    this.group.matrix
      .copy(matrixOf(this.poseAt(world_s)))
      .multiply(new Matrix4().makeScale(scale, scale, scale));
    this.group.matrixWorldNeedsUpdate = true;
  }

  /** Distance along a ray to its box; null: no hit. */
  rayDistance(ray: Ray): number | null {
    if (!this.group.visible || this.layer.table.size === 0) return null;
    const own = ray.clone().applyMatrix4(this.group.matrix.clone().invert());
    const hit = own.intersectBox(this.layer.table.box(0), new Vector3());
    return hit ? hit.applyMatrix4(this.group.matrix).distanceTo(ray.origin) : null;
  }
}

export class WorldObjects implements Grabbable {
  readonly object = new Group();
  objects: PlacedObject[] = [];
  private world_s = 0;
  private held: { object: PlacedObject; index: number; plane: Plane; from: Vector3 } | null = null;

  constructor(
    private readonly view: SceneView,
    private readonly events: ObjectsEvents,
  ) {}

  async load(scene: SceneInfo) {
    const layers = new Map<number, Layer>();
    try {
      for (const info of scene.objects)
        if (!layers.has(info.geometry.id))
          layers.set(info.geometry.id, await this.loadGeometry(info));
    } catch (error) {
      this.events.failed(error);
      return;
    }
    this.object.clear();
    this.objects = scene.objects.map(
      (info) => new PlacedObject(info, layers.get(info.geometry.id)!),
    );
    for (const placed of this.objects) {
      placed.group.add(...placed.layer.instances(placed.info.class_id));
      this.object.add(placed.group);
    }
    this.view.movable = this.objects.map((placed) => placed.group);
    this.step(this.world_s);
  }

  /** Moves all objects to a world time. */
  step(world_s: number) {
    this.world_s = world_s;
    for (const placed of this.objects) placed.place(world_s);
    if (this.objects.length > 0) this.view.invalidate();
  }

  /** Returns all objects to their own motion. */
  release() {
    this.objects.forEach((placed, index) => {
      if (!placed.dragged) return;
      placed.dragged = null;
      this.events.placed(index, null);
    });
    this.step(this.world_s);
  }

  poseOf(index: number): Pose {
    return this.objects[index].poseAt(this.world_s);
  }

  isAt(camera: PerspectiveCamera, screen: Vector2): boolean {
    return this.at(camera, screen) !== null;
  }

  highlight() {}

  grab(camera: PerspectiveCamera, screen: Vector2) {
    const found = this.at(camera, screen);
    if (!found) return;
    const { placed, ray, distance_m } = found;
    const hit = ray.at(distance_m, new Vector3());
    this.held = {
      object: placed,
      index: this.objects.indexOf(placed),
      plane: new Plane(new Vector3(0, 0, 1), -hit.z),
      from: hit,
    };
    placed.dragged = [...placed.poseAt(this.world_s)];
  }

  drag(ray: Ray) {
    if (!this.held?.object.dragged) return;
    const { object, index, plane, from } = this.held;
    const hit = ray.intersectPlane(plane, new Vector3());
    if (!hit || hit.distanceTo(ray.origin) > kMaxDragM) return;
    const pose: Pose = [...this.held.object.dragged];
    pose[0] += hit.x - from.x;
    pose[1] += hit.y - from.y;
    this.held.from = hit;
    object.dragged = pose;
    object.place(this.world_s);
    this.events.placed(index, pose);
    this.view.invalidate();
  }

  private at(camera: PerspectiveCamera, screen: Vector2) {
    const caster = new Raycaster();
    caster.setFromCamera(screen, camera);
    const { ray } = caster;
    let nearest: { placed: PlacedObject; ray: Ray; distance_m: number } | null = null;
    for (const placed of this.objects) {
      const distance_m = placed.rayDistance(ray);
      if (distance_m === null || (nearest && nearest.distance_m <= distance_m)) continue;
      nearest = { placed, ray, distance_m };
    }
    return nearest;
  }

  private async loadGeometry({ geometry }: ObjectInfo): Promise<Layer> {
    const layer = await openLayer(geometry, this.view.shared);
    const { signal } = new AbortController();
    for (const node of await detailOf(layer, signal))
      layer.add(node, await layer.load(node, signal));
    return layer;
  }
}

/** Nodes of the finest level within kMaxElements, and the leaves above it. */
async function detailOf(layer: Layer, signal: AbortSignal): Promise<number[]> {
  const { table } = layer;
  let nodes = [0];
  for (;;) {
    const next: number[] = [];
    for (const node of nodes) {
      const children = await layer.childrenOf(node, signal);
      next.push(...(children.length > 0 ? children : [node]));
    }
    const isFinest = next.every((n, i) => n === nodes[i]);
    const elements = next.reduce((sum, n) => sum + table.node(n).count, 0);
    if (isFinest || elements > kMaxElements) return nodes;
    nodes = next;
  }
}
