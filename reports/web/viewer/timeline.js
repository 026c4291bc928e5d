import { css } from "./colours.js";
import { make } from "./dom.js";
import { language } from "./words/words.js";

const kSteps = 10000;

/** A slider of the time, with a mark for each impact above it: taller where more come together. */
export class Timeline {
  constructor(duration, goTo) {
    this.duration = duration;
    this.marks = make("canvas", { className: "cv-marks", "aria-hidden": "true" });
    this.slider = make("input", { type: "range", min: 0, max: kSteps, step: 1, value: 0, className: "cv-slider" });
    this.slider.addEventListener("input", () => goTo(this.slider.value / kSteps * duration));
    this.element = make("div", { className: "cv-timeline" }, this.marks, this.slider);
  }

  show(time) {
    this.slider.value = Math.round(time / this.duration * kSteps);
    const { words } = language;
    this.slider.setAttribute("aria-label", words.timeline);
    this.slider.setAttribute("aria-valuetext", words.clock(language.number(time), language.number(this.duration)));
  }

  draw(motions, theme) {
    const scale = devicePixelRatio || 1;
    const [width, height] = [this.marks.clientWidth || 300, this.marks.clientHeight || 16];
    Object.assign(this.marks, { width: width * scale, height: height * scale });
    const context = this.marks.getContext("2d");
    context.scale(scale, scale);
    motions.forEach((motion, index) => {
      const bins = new Float64Array(Math.max(Math.floor(width / 2), 1));
      const at = (time) => Math.min(Math.floor(time / this.duration * bins.length), bins.length - 1);
      for (const { time } of motion.impacts) bins[at(time)] += 1;
      // Where not all impacts are listed, the frames tell how many there were between them.
      const listed = motion.moreImpacts ? motion.impacts.at(-1)?.time ?? 0 : Infinity;
      for (let k = 1; k < motion.frames; k += 1) {
        if (motion.times[k - 1] < listed) continue;
        const [first, last] = [at(motion.times[k - 1]), at(motion.times[k])];
        for (let bin = first; bin <= last; bin += 1) bins[bin] += (motion.counted[k] - motion.counted[k - 1]) / (last - first + 1);
      }
      const most = Math.max(...bins, 1);
      const [base, room] = motions.length === 1 ? [height, height] : [index === 0 ? height / 2 : height, height / 2];
      context.fillStyle = css(index === 0 ? theme.ink : theme.impulse);
      bins.forEach((count, k) => {
        if (count === 0) return;
        const tall = (0.4 + 0.6 * count / most) * (room - 1);
        context.fillRect(2 * k, base - tall, 1.5, tall);
      });
    });
  }
}
