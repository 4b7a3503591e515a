// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Early requests: fetches what every first picture needs at once, while the scripts start.

/** The scene, and of the first layer the first block and the root. */
const kEarlyPaths = ['scene.json', 'layers/0/table/0.bin', 'layers/0/nodes/0.bin'];

const early = new Map(kEarlyPaths.map((path) => [path, fetch(path)]));
// The caller of fetchOnce() sees the failure.
for (const reply of early.values()) reply.catch(() => {});

/** Like fetch, but uses an early reply once if there is one. */
export function fetchOnce(path: string, signal?: AbortSignal): Promise<Response> {
  const reply = early.get(path);
  early.delete(path);
  return reply ?? fetch(path, { signal });
}

/** Discards early replies, which may belong to another scene by now. */
export function dropEarly() {
  early.clear();
}

/** Fetches bytes. Rejects like fetch, and if the server's status is not 200-299. */
export async function fetchBytes(path: string, signal: AbortSignal): Promise<ArrayBuffer> {
  const reply = await fetchOnce(path, signal);
  if (!reply.ok) throw new Error(`${path}: ${reply.status}`);
  return reply.arrayBuffer();
}
