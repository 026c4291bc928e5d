// The exact probability that a particle passes a rectangular barrier of height V and thickness a:
//   E < V: T = 1/(1 + V² sinh²(κa)/(4E(V − E))), κ = √(2m(V − E))/ħ                                      (1)
//   E > V: T = 1/(1 + V² sin²(ka)/(4E(E − V))),  k = √(2m(E − V))/ħ                                      (2)
//   E = V: T = 1/(1 + m a² V/(2ħ²))                                                                      (3)
// E = ½ m v_n² is the energy of its motion across. Any textbook of quantum mechanics.

export function transmission({ energy, mass, height, thickness, hbar }) {
  if (energy <= 0) return 0;
  const above = energy - height;
  if (above === 0) return 1 / (1 + mass * thickness ** 2 * height / (2 * hbar ** 2));
  const wave = Math.sqrt(2 * mass * Math.abs(above)) / hbar * thickness;
  const turn = above < 0 ? Math.sinh(wave) : Math.sin(wave);
  return 1 / (1 + height ** 2 * turn ** 2 / (4 * energy * Math.abs(above)));
}

const across = (normal, list, i) => normal[0] * list[3 * i] + normal[1] * list[3 * i + 1] + normal[2] * list[3 * i + 2];

/** How many balls are beyond a sheet that they started before, and how many were sent back from it. */
export function countAcross(sheet, motion, state) {
  const start = motion.positions;
  const speeds = motion.velocities;
  let sent = 0;
  let back = 0;
  for (let i = 0; i < motion.balls; i += 1) {
    const side = Math.sign(across(sheet.normal, start, i) - sheet.offset);
    const now = across(sheet.normal, state.x, i) - sheet.offset;
    if (side * now < 0) sent += 1;
    else if (across(sheet.normal, speeds, i) * side < 0 && across(sheet.normal, state.v, i) * side > 0) back += 1;
  }
  return { sent, back };
}

/** The mean of T over the balls, and the standard error of the fraction that passes. */
export function expectedAcross(barrier, motion, masses) {
  let sum = 0;
  let variance = 0;
  for (let i = 0; i < motion.balls; i += 1) {
    const speed = across(barrier.normal, motion.velocities, i);
    const t = transmission({ energy: 0.5 * masses[i] * speed ** 2, mass: masses[i], ...barrier });
    sum += t;
    variance += t * (1 - t);
  }
  return { expected: sum / motion.balls, error: Math.sqrt(variance) / motion.balls };
}
