// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What every first picture needs is asked for at once: while the page's scripts begin, and not one
// reply after another.

/** Of the layer that every view has, its first nodes and its root. */
const kFirst = ['scene.json', 'layers/0/table/0.bin', 'layers/0/nodes/0.bin'];

const early = new Map(kFirst.map((path) => [path, fetch(path)]));
// Whoever asks for it sees the failure.
for (const reply of early.values()) reply.catch(() => {});

/** As fetch; the first time with the reply to what was asked for early. */
export function askOnce(path: string, signal?: AbortSignal): Promise<Response> {
  const reply = early.get(path);
  early.delete(path);
  return reply ?? fetch(path, { signal });
}

/** What was asked for early may be of another scene by now. */
export function forgetEarly() {
  early.clear();
}

/** The bytes. Rejects as fetch does, and where the server has no such thing. */
export async function ask(path: string, signal: AbortSignal): Promise<ArrayBuffer> {
  const reply = await askOnce(path, signal);
  if (!reply.ok) throw new Error(`${path}: ${reply.status}`);
  return reply.arrayBuffer();
}
