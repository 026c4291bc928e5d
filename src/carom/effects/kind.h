#pragma once

namespace carom {

/// What an effect does to the velocity, and so which function it has:
///   field    acceleration(world, ball), a₀, which does not depend on the velocity;
///   damping  damping_rate(world, ball, velocity), the λ >= 0 of an acceleration -λ v;
///   turning  turning_rate(world, ball), the Ω of an acceleration Ω × v.
enum class EffectKind { field, damping, turning };

}  // namespace carom
