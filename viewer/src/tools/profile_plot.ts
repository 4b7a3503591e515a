// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Plots a profile: height over distance along the slice. Heights of flat profiles are exaggerated by
// an integer factor, which the plot states.

import type { Vec3 } from '../server/protocol';
import type { SlicePoint } from './slice';

const kMargin = { left: 52, right: 12, top: 10, bottom: 30 };
const kGround = '#0d1014';
const kInk = '#8c99a8';
const kLine = '#2b343e';
const kMaxFactor = 10;

/** Tick distance for about `count` steps: 1, 2 or 5 times a power of ten. */
function tickStep(span: number, count: number): number {
  const rough = span / count;
  const power = 10 ** Math.floor(Math.log10(Math.max(rough, 1e-9)));
  return [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough) ?? 10 * power;
}

export interface Plot {
  points: SlicePoint[];
  length_m: number;
  /** Added to heights to get world heights. */
  origin_m: Vec3;
  color(point: SlicePoint): string;
}

export function drawProfile(canvas: HTMLCanvasElement, plot: Plot) {
  const context = canvas.getContext('2d');
  if (!context) return;
  const { width, height } = canvas;
  context.fillStyle = kGround;
  context.fillRect(0, 0, width, height);
  const { points, length_m, origin_m } = plot;
  if (points.length === 0) return;
  let [low, high] = [Infinity, -Infinity];
  for (const { position } of points) {
    low = Math.min(low, position.z);
    high = Math.max(high, position.z);
  }
  const area = {
    x: width - kMargin.left - kMargin.right,
    y: height - kMargin.top - kMargin.bottom,
  };
  const scale = Math.min(area.x / length_m, area.y / Math.max(high - low, 0.05));
  const fitting = Math.floor(area.y / (Math.max(high - low, 0.05) * scale));
  const factor = Math.min(Math.max(fitting, 1), kMaxFactor);
  const x = (along: number) => kMargin.left + along * scale;
  const y = (z: number) => kMargin.top + area.y - (z - low) * scale * factor;
  drawTicks(context, { x, y, low, high, length_m, up_m: origin_m[2], width, height });
  if (factor > 1) {
    context.textAlign = 'right';
    context.fillText(`heights ${factor} ×`, width - kMargin.right, kMargin.top + 10);
  }
  for (const point of points) {
    context.fillStyle = plot.color(point);
    context.fillRect(x(point.along_m) - 1, y(point.position.z) - 1, 2, 2);
  }
}

interface Axes {
  x(along: number): number;
  y(z: number): number;
  low: number;
  high: number;
  length_m: number;
  up_m: number;
  width: number;
  height: number;
}

function drawTicks(context: CanvasRenderingContext2D, axes: Axes) {
  const { x, y, low, high, length_m, up_m, height } = axes;
  context.font = '11px system-ui, sans-serif';
  context.strokeStyle = kLine;
  context.fillStyle = kInk;
  context.textAlign = 'center';
  const step = tickStep(length_m, 8);
  for (let at = 0; at <= length_m + 1e-9; at += step) {
    context.beginPath();
    context.moveTo(x(at), kMargin.top);
    context.lineTo(x(at), height - kMargin.bottom);
    context.stroke();
    context.fillText(`${Number(at.toFixed(6))} m`, x(at), height - kMargin.bottom + 14);
  }
  context.textAlign = 'right';
  const rise = tickStep(Math.max(high - low, 0.05), 4);
  for (let z = Math.ceil((low + up_m) / rise) * rise; z <= high + up_m + 1e-9; z += rise) {
    context.beginPath();
    context.moveTo(x(0), y(z - up_m));
    context.lineTo(x(length_m), y(z - up_m));
    context.stroke();
    context.fillText(Number(z.toFixed(6)).toString(), kMargin.left - 6, y(z - up_m) + 4);
  }
}
