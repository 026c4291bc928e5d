#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"
#include "report/page/orders.h"
#include "tests/report/cells.h"
#include "tests/support/folder.h"

namespace carom::test {
namespace {

using page::Node;
using testing::AllOf;
using testing::HasSubstr;

std::string orders_chapter_of(const std::filesystem::path& file) {
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_orders(body, file);
  return page::markup(body);
}

std::string orders_chapter_of_text(const std::string& text) {
  const test::TestFolder folder;
  write_file(folder / "orders-of-a-test.json", text);
  return orders_chapter_of(folder / "orders-of-a-test.json");
}

TEST(OrdersChapter, ShowsClaimMeasurementFitAndErrors_OfEachEvolver) {
  const std::string text = orders_chapter_of_text(R"([
    {"scene": "a/b", "evolver": "step", "refuses": "", "claimed": 1, "order": 1.01234, "r_squared": 0.999876,
     "errors": [{"step_s": 0.25, "error_m": 0.5, "rounding_m": 1e-15},
                {"step_s": 0.125, "error_m": 0.2, "rounding_m": 1e-15},
                {"step_s": 0.0625, "error_m": 0.125, "rounding_m": 1e-15}]},
    {"scene": "a/b", "evolver": "toi", "refuses": "", "claimed": null, "order": null, "r_squared": null,
     "errors": [{"step_s": 0.25, "error_m": 2e-16, "rounding_m": 1e-15}]},
    {"scene": "a/b", "evolver": "event", "refuses": "no <drag>"}])");
  EXPECT_THAT(text, AllOf(HasSubstr("a/b</th><td>step</td>" + cell("1") + cell("1.012") + cell("0.99988") +
                                    cell("0.5 m at 0.25 s") + cell("0.125 m at 0.0625 s")),
                          HasSubstr("toi</td>" + cell("exact") + cell("rounding") + cell("–") +
                                    cell("2e-16 m at 0.25 s")),
                          HasSubstr("does not take it: no &lt;drag&gt;</td>")));
}

TEST(OrdersChapter, IsAbsentWithoutTheFile) {
  pugi::xml_document document;
  page::add_orders(document.append_child("body"), "/nowhere/orders.json");
  EXPECT_TRUE(document.child("body").first_child().empty());
}

TEST(OrdersChapter, NamesTheFile_ThatItCannotUse) {
  for (const char* bad :
       {"{", "{}", "[]", "[{}]", "[1]",
        R"([{"scene": "a/b", "evolver": "toi", "refuses": "", "claimed": 1, "order": 1, "r_squared": 1,
             "errors": []}])"}) {
    EXPECT_THAT([&] { orders_chapter_of_text(bad); },
                testing::ThrowsMessage<InputError>(AllOf(HasSubstr("orders-of-a-test.json"),
                                                         HasSubstr("tests/benchmarks/run writes it anew"))))
        << bad;
  }
}

// What is committed is what the chapter takes.
TEST(OrdersChapter, TakesTheFileOfThisProgram) {
  EXPECT_THAT(orders_chapter_of(std::filesystem::path(CAROM_SOURCE_DIR) / "reports/measured/orders.json"),
              AllOf(HasSubstr("flight/quadratic-drag"), HasSubstr("impact/oblique")));
}

}  // namespace
}  // namespace carom::test
