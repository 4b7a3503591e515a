// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Records the canvas as a video.

const kFramesPerSecond = 30;
const kBitsPerSecond = 12e6;
/** Maximum length; longer films would fill the page's memory. */
const kMaxFilmMs = 120_000;
const kTypes = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];

interface FilmEvents {
  done(film: Blob): void;
  failed(error: unknown): void;
}

export class Film {
  private recorder: MediaRecorder | null = null;
  private timer = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly events: FilmEvents,
  ) {}

  get recording(): boolean {
    return this.recorder !== null;
  }

  /** Throws if the browser cannot record video. */
  start() {
    const type = kTypes.find((t) => MediaRecorder.isTypeSupported(t));
    if (!type) throw new Error('This browser cannot record video');
    const stream = this.canvas.captureStream(kFramesPerSecond);
    const recorder = new MediaRecorder(stream, {
      mimeType: type,
      videoBitsPerSecond: kBitsPerSecond,
    });
    const parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => data.size > 0 && parts.push(data);
    recorder.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      this.events.done(new Blob(parts, { type: type.split(';')[0] }));
    };
    recorder.onerror = () => this.events.failed(new Error('Recording the film failed'));
    recorder.start(1000);
    this.recorder = recorder;
    this.timer = window.setTimeout(() => this.stop(), kMaxFilmMs);
  }

  stop() {
    window.clearTimeout(this.timer);
    this.recorder?.stop();
    this.recorder = null;
  }
}
