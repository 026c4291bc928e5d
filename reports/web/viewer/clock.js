// One clock for all runs. Speeds are powers of two, from 1/64 to 4.

export const kSpeeds = [1 / 64, 1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4];
const kShortest_s = 3;
const kLongest_s = 40;
const kPlayed_s = 12;

export class Clock {
  constructor(duration) {
    this.duration = duration;
    this.time = 0;
    this.speed = 1;
    this.playing = false;
    // What is over in a moment, or takes an hour, is played in 12 s.
    this.rate = duration >= kShortest_s && duration <= kLongest_s ? 1 : duration / kPlayed_s;
  }

  /** Moves on by some seconds of the person who watches. @returns whether the time changed */
  tick(seconds) {
    if (!this.playing) return false;
    this.time = Math.min(this.time + seconds * this.rate * this.speed, this.duration);
    if (this.time >= this.duration) this.playing = false;
    return true;
  }

  toggle() {
    if (!this.playing && this.time >= this.duration) this.time = 0;
    this.playing = !this.playing;
  }

  faster(steps) {
    const at = Math.min(Math.max(kSpeeds.indexOf(this.speed) + steps, 0), kSpeeds.length - 1);
    this.speed = kSpeeds[at];
  }

  goTo(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
  }
}

export const nameOfSpeed = (speed) => (speed < 1 ? `1/${Math.round(1 / speed)}` : String(speed));
