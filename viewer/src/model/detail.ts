/** How finely the scene is drawn while it moves, so that it follows the hand on any machine. At rest all is drawn. */

export interface Detail {
  /** Voxels as faces (0), or as points that stand for a block of so many per side. */
  block: number;
  /** Pixels per side, as a share. */
  pixels: number;
}

const LADDER: readonly Detail[] = [
  { block: 0, pixels: 1 },
  { block: 1, pixels: 1 },
  { block: 2, pixels: 1 },
  { block: 2, pixels: 0.7 },
  { block: 3, pixels: 0.5 },
];

/** Frames that take longer are slow; drawing is about two thirds of what passes between frames. */
export const SLOW_MS = 30;
const FAST_MS = 8;
/** So many slow frames of the last WINDOW lead a step down: one may be slow by chance. */
const WINDOW = 5;
const SLOW_FRAMES = 3;

/** Learns from the times of the frames which step is fast enough. */
export class DetailChooser {
  private step = 0;
  private last: number[] = [];
  private movement: number[] = [];
  private held = false;

  get detail(): Detail {
    return LADDER[this.step];
  }

  /** Stays at a step whatever the times, for measurements. */
  hold(step: number): void {
    this.step = step;
    this.held = true;
  }

  /** A frame of a movement took so many milliseconds to draw. True where the next one is drawn otherwise. */
  frame(milliseconds: number): boolean {
    if (this.held) return false;
    this.movement.push(milliseconds);
    this.last.push(milliseconds);
    if (this.last.length > WINDOW) this.last.shift();
    if (this.step === LADDER.length - 1 || this.last.filter((t) => t > SLOW_MS).length < SLOW_FRAMES) return false;
    ++this.step;
    this.last = [];
    this.movement = [];
    return true;
  }

  /** The movement ended. Where there was time to spare the next one is drawn more finely. */
  rest(): void {
    const times = this.movement.sort((a, b) => a - b);
    if (this.step > 0 && times.length >= 10 && times[times.length >> 1] < FAST_MS) --this.step;
    this.last = [];
    this.movement = [];
  }
}
