#pragma once

namespace carom::test {

/// The file of a scene in which one ball meets another, off its centre, after 0.4 s.
inline constexpr const char* kTwoBalls = R"(title = "Two"
dimension = 2
duration = 1.0
step = 0.01
frames = 10
[[ball]]
mass = 1
radius = 0.1
position = [0, 0]
velocity = [1, 0]
[[ball]]
mass = 1
radius = 0.1
position = [0.6, 0.05]
)";

}  // namespace carom::test
