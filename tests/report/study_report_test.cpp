#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "report/study_csv.h"
#include "report/study_table.h"
#include "report/study_words.h"
#include "study/analyse.h"
#include "tests/report/studies.h"

namespace carom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The fields of each row, as RFC 4180 has them.
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string>& fields = rows.emplace_back(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const bool doubled = quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) {
        fields.back() += line[++i];
      } else if (line[i] == '"') {
        quoted = !quoted;
      } else if (line[i] == ',' && !quoted) {
        fields.emplace_back();
      } else {
        fields.back() += line[i];
      }
    }
  }
  return rows;
}

TEST(StudyCsv, ReadsBack_ToWhatWasMeasured) {
  Study study = some_study();
  study.growths.push_back(
      {2, 0.2, "peer", {{100, RunStatus::ok, "", 20, 5, {2e-4}}, {1000, {}, "", 20, 0, {}}}});
  const auto rows = read_csv(study_csv(study));
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  const std::vector<StudyPoint>& points = study.scenes[0].points;
  ASSERT_EQ(rows.size(), points.size() + 3);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<std::string>& row = rows[i + 1];
    EXPECT_EQ(row[column("engine")], points[i].engine);
    EXPECT_EQ(row[column("setting")], points[i].setting);
    EXPECT_EQ(row[column("reason")], points[i].reason);
    EXPECT_EQ(std::stod(row[column("step")]), points[i].step_s);
    if (points[i].status != RunStatus::ok) continue;
    EXPECT_EQ(std::stod(row[column("position")]), *points[i].errors.position_m);
    EXPECT_EQ(std::stod(row[column("cpu_median")]), points[i].cpu_s[1]);
  }
  const std::vector<std::string>& growth = rows[points.size() + 1];
  EXPECT_EQ(growth[column("scene")], "gas of 100 balls in dimension 2");
  EXPECT_EQ(growth[column("cpu_median")], "0.0002");
  EXPECT_EQ(growth[column("ns_per_ball_and_step")], "100");
  EXPECT_EQ(rows[1][column("on_front")], "1");
  EXPECT_EQ(rows[1][column("ns_per_ball_and_step")], "") << "it has no steps";
  EXPECT_EQ(rows[3][column("on_front")], "0") << "slower than event, and worse";
}

TEST(StudyTable, FitsATerminal_AndSaysWhoIsAhead) {
  const std::string table = study_table(some_study());
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) {
    const auto columns = std::count_if(line.begin(), line.end(), [](char byte) {
      return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
    });
    EXPECT_LE(columns, 80) << line;
  }
  EXPECT_THAT(table, HasSubstr("ahead: peer, step 0.1 s: 0.001 m in 1.0 µs; carom needs 2.0 µs"));
  EXPECT_THAT(table, HasSubstr("crashed: ended by a \"signal\", early"));
  EXPECT_THAT(table, HasSubstr("1.00")) << "the order of the peer";
  EXPECT_THAT(table, HasSubstr("10.0")) << "the price of a digit";
}

TEST(StudyTable, SaysSo_WhereNobodyIsAhead) {
  Study study = some_study();
  study.scenes[0].points[0].cpu_s = {5e-7, 5e-7};
  const std::string table = study_table(study);
  EXPECT_THAT(table, HasSubstr("carom's front lies at or below every peer's"));
  EXPECT_THAT(table, Not(HasSubstr("ahead:")));
}

TEST(TimeWords, HaveTwoOrThreeDigits) {
  EXPECT_EQ(time_words(4.13e-7), "413 ns");
  EXPECT_EQ(time_words(3.14e-6), "3.1 µs");
  EXPECT_EQ(time_words(0.0281), "28 ms");
  EXPECT_EQ(time_words(0.99996), "1.0 s");
  EXPECT_EQ(time_words(12.0), "12 s");
}

}  // namespace
}  // namespace carom::test
