// After Okabe and Ito, who chose them for all kinds of colour vision. Numbers from 0 to 1.

const hex = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);

const kShades = 256;

export const kBallColours = ["#E69F00", "#56B4E9", "#009E73", "#CC79A7", "#0072B2", "#D55E00", "#F0E442", "#8A929B"].map(hex);
export const kPlain = hex("#56B4E9");
export const kGhost = hex("#D55E00");

export const kThemes = {
  light: { paper: hex("#FFFFFF"), ink: hex("#1d2329"), quiet: hex("#98a0a8"), wall: hex("#59626c"), slab: hex("#8a6d3b"),
    barrier: hex("#7b4fa3"), tree: hex("#00805c"), velocity: hex("#0b3c5d"), momentum: hex("#a3407f"),
    impulse: hex("#c64f00"), centre: hex("#1d2329") },
  dark: { paper: hex("#1b2026"), ink: hex("#e8e6e1"), quiet: hex("#5b646e"), wall: hex("#a3acb5"), slab: hex("#c9a86a"),
    barrier: hex("#b48ade"), tree: hex("#2fcf9f"), velocity: hex("#ffffff"), momentum: hex("#e79bcb"),
    impulse: hex("#ff8f45"), centre: hex("#e8e6e1") },
};

/** The same from a table: a picture asks for thousands of colours, and makes none. */
export function tabled(colours) {
  const table = Array.from({ length: kShades + 1 }, (_, k) => colours(k / kShades));
  return (share) => table[Math.round(kShades * Math.min(Math.max(share, 0), 1))];
}

/** From dark blue over grey to yellow, lighter and lighter, so that it reads without colour too. */
export function ramp(share) {
  const stops = [hex("#00336f"), hex("#5c6d8c"), hex("#a59c74"), hex("#ffe945")];
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  return stops[k].map((x, c) => x + (at - k) * (stops[k + 1][c] - x));
}

/** From pale blue where two runs agree to orange where they have parted. */
export function parted(share) {
  const [a, b] = [hex("#8fb8d8"), hex("#D55E00")];
  const s = Math.min(Math.max(share, 0), 1);
  return a.map((x, c) => x + s * (b[c] - x));
}

export const css = (colour, alpha = 1) => `rgba(${colour.map((x) => Math.round(255 * x)).join(",")},${alpha})`;
