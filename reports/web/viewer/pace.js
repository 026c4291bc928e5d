// How finely pictures are drawn while they move. Without a graphics card every pixel takes its time: where pictures come
// too slowly they are drawn with fewer pixels, and with all of them again once there is time, or nothing moves.

const kQualities = [1, 0.7, 0.5, 0.35]; // pixels along an edge, by those of the screen
const kSlow_ms = 50;  // between two pictures: fewer than 20 a second
const kFast_ms = 22;  // a level up has at most twice the pixels, and stays below kSlow_ms
const kSlowOnes = 5;  // so many in a row, so that one hiccup changes nothing
const kFastOnes = 120;

export class Pace {
  constructor() {
    this.level = 0;
    this.slow = 0;
    this.fast = 0;
  }

  get quality() { return kQualities[this.level]; }

  /** @param ms  since the picture before, while it plays */
  took(ms) {
    this.slow = ms > kSlow_ms ? this.slow + 1 : 0;
    this.fast = ms < kFast_ms ? this.fast + 1 : 0;
    if (this.slow >= kSlowOnes && this.level < kQualities.length - 1) this.turn(1);
    else if (this.fast >= kFastOnes && this.level > 0) this.turn(-1);
  }

  turn(by) {
    this.level += by;
    this.slow = this.fast = 0;
  }
}
