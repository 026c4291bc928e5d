#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/files.h"
#include "tests/benchmarks/convergence.h"

// The orders of convergence that the page shows.

namespace carom::test {
namespace {

/// With the step halved five times, x = 0 … 5, the slope of y = log₂ error is Σ (x - 5/2) y / 17.5. What may
/// shift it from the order:
/// - An impact's share of a step is uniform: its mean over 64 is off by 1/√(3·64) = 7 % as a standard
///   deviation, or 0.104 in y, which is 0.104/√17.5 = 0.025 in the slope.
/// - The next term of C hᵖ (1 + D h), where D h/2ˣ log₂ e are added to y: 0.26 D h. The longest steps are
///   chosen such that D h is below 0.09.
/// Three deviations and the bend are 0.075 + 0.024. Another order would be off by one.
constexpr double kOrderTolerance = 0.1;

nlohmann::json shown() {
  return nlohmann::json::parse(read_file(CAROM_SOURCE_DIR "/reports/measured/orders.json"));
}

TEST(Orders, AreWhatTheEvolversClaim) {
  int orders = 0;
  int exact = 0;
  for (const auto& row : shown()) {
    if (row.at("refuses") != "") continue;
    SCOPED_TRACE(row.at("scene").get<std::string>() + " in " + row.at("evolver").get<std::string>());
    ASSERT_EQ(row.at("order").is_null(), row.at("claimed").is_null()) << "an order, or rounding alone";
    if (row.at("claimed").is_null()) {
      ++exact;
      continue;
    }
    ++orders;
    EXPECT_NEAR(row.at("order").get<double>(), row.at("claimed").get<int>(), kOrderTolerance);
  }
  EXPECT_EQ(orders, 9) << "step in six scenes, toi in three that are not exact";
  EXPECT_EQ(exact, 5) << "toi in three scenes, event in two";
}

// What the page shows is what Carom does now, not what it did once. Another compiler may round otherwise.
TEST(Orders, PagesFile_IsUpToDate) {
  const nlohmann::json all = shown();
  const std::vector<Convergence> measured = measure_convergence(CAROM_SOURCE_DIR "/scenarios");
  ASSERT_EQ(all.size(), measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Convergence& row = measured[i];
    const nlohmann::json& file = all.at(i);
    SCOPED_TRACE(row.scene + " in " + row.evolver);
    EXPECT_EQ(file.at("scene"), row.scene);
    EXPECT_EQ(file.at("evolver"), row.evolver);
    ASSERT_EQ(file.at("refuses"), row.refuses);
    if (!row.refuses.empty()) continue;
    EXPECT_EQ(file.at("claimed"), row.claimed ? nlohmann::json(*row.claimed) : nlohmann::json());
    ASSERT_EQ(file.at("errors").size(), row.errors.size());
    double share_of_rounding = 0.0;
    for (std::size_t k = 0; k < row.errors.size(); ++k) {
      const StepError& error = row.errors[k];
      EXPECT_DOUBLE_EQ(file.at("errors").at(k).at("step_s").get<double>(), error.step_s);
      EXPECT_NEAR(file.at("errors").at(k).at("error_m").get<double>(), error.error_m, error.rounding_m);
      share_of_rounding = std::max(share_of_rounding, error.rounding_m / error.error_m);
    }
    ASSERT_EQ(file.at("order").is_null(), !row.order);
    // Σ |x - 5/2| / 17.5 log₂ e = 0.742
    if (row.order) {
      EXPECT_NEAR(file.at("order").get<double>(), *row.order, 0.75 * share_of_rounding);
    }
  }
}

}  // namespace
}  // namespace carom::test
