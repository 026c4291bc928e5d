export const kParts = ["translation", "rotation", "potential"];

/** The energies of a run at a time: between two frames as they are on the line between them. */
export function energiesAt(motion, time) {
  const k = motion.frameAt(Math.min(time, motion.end));
  const next = Math.min(k + 1, motion.frames - 1);
  const h = motion.times[next] - motion.times[k];
  const share = h > 0 ? Math.min(Math.max((time - motion.times[k]) / h, 0), 1) : 0;
  // Energy jumps at an impact and does not slide: what is shown is that of the nearer frame.
  const frame = share < 0.5 ? k : next;
  const at = Object.fromEntries(kParts.map((part) => [part, motion[part][frame]]));
  const start = kParts.reduce((sum, part) => sum + motion[part][0], 0);
  const now = kParts.reduce((sum, part) => sum + at[part], 0);
  // What events brought is no gain of the engine's, and what they took no loss.
  const added = motion.added[frame];
  const due = start + added;
  // A sum of energies is right to a few roundings: less is not called lost.
  const lost = Math.abs(due - now) > 1e-9 * Math.max(Math.abs(start), Math.abs(due)) ? due - now : 0;
  return { ...at, lost, added, start, total: now };
}
