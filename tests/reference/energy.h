#pragma once

#include "tests/reference/support.h"

namespace carom::reference_test {

// What the energy account of every reference adapter has to hold. Each function returns an error, relative to
// the energy at the start; the test says how large it may be.

inline double sum_of(const EnergyAccount& energy) {
  return energy.ball_impacts_J + energy.wall_impacts_J + energy.friction_J + energy.correction_J;
}

/// Without fields nothing changes energy but pushes: the part of a rough, lossy gas' change of energy that
/// the account does not explain.
inline double unexplained_energy_of_gas(const Engine& engine, const char* profile, int dimension) {
  Scenario scene = gas(dimension, dimension == 2 ? 8 : 4, 1.0 / 240.0, 480);
  scene.effects.spin = true;
  scene.ball_contact = {0.9, 0.2, 0.0};
  scene.wall_contact = {0.8, 0.3, 0.0};
  Probe probe(engine, scene, profile);
  const double before_J = probe.kinetic_energy();
  probe.advance(scene.frames);
  const double change_J = probe.kinetic_energy() - before_J;
  return std::abs(sum_of(probe.tally().energy) - change_J) / before_J;
}

/// A smooth ball hits a wall at e = 0.5: what its account of wall impacts is off (1 - e²) of its energy, and
/// what it books elsewhere.
inline double wall_impact_error(const Engine& engine, int dimension) {
  Scenario scene = scene_of(dimension, 1e-3, 500);
  scene.wall_contact.restitution = 0.5;
  scene.walls = {{Vec3::UnitY(), 0.0}};
  scene.balls = {ball(2.0, 0.1, Vec3(0, 0.5, 0), Vec3(0, -2.0, 0))};
  Probe probe(engine, scene);
  const double before_J = probe.kinetic_energy();
  probe.advance(scene.frames);
  const EnergyAccount energy = probe.tally().energy;
  return (std::abs(energy.wall_impacts_J + 0.75 * before_J) + std::abs(energy.ball_impacts_J) +
          std::abs(energy.friction_J) + std::abs(energy.correction_J)) /
         before_J;
}

}  // namespace carom::reference_test
