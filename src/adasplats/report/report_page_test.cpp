// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/report_page.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "adasplats/report/chart.h"
#include "adasplats/report/results.h"
#include "adasplats/report/sample_results_test.h"
#include "adasplats/report/text_format.h"

namespace adasplats::page {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The rows of HTML tables that begin with this name.
std::vector<std::string> rows_named(const std::string& html, const std::string& name) {
  std::vector<std::string> rows;
  const std::string end = html_escape(name) + "<";
  for (auto at = html.find("<tr>"); at != std::string::npos; at = html.find("<tr>", at + 1)) {
    const std::string row = html.substr(at, html.find("</tr>", at) - at);
    const auto head = row.substr(0, row.find("</th>") + 1);
    if (head.find(end) != std::string::npos) rows.push_back(row);
  }
  return rows;
}

void expect_complete(const Json& results) {
  const std::string html = report_html(results, std::filesystem::path());
  for (const std::string tag : {"section", "table", "figure", "svg", "dl", "tr"}) {
    EXPECT_EQ(count_of(html, "<" + tag + ">") + count_of(html, "<" + tag + " "),
              count_of(html, "</" + tag + ">"))
        << tag;
  }
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_FALSE(report_markdown(results).empty());
}

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::path(testing::TempDir()) / "adasplats-report-page") {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "pictures");
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
  }

 private:
  std::filesystem::path path_;
};

TEST(TextFormat, NumbersAreReadable) {
  EXPECT_EQ(fixed_text(1234567.891, 1), "1,234,567.9");
  EXPECT_EQ(fixed_text(-1234, 0), "-1,234");
  EXPECT_EQ(fixed_text(-0.001, 1), "0.0");
  EXPECT_EQ(fixed_text(std::nan(""), 1), kMissing);
  EXPECT_EQ(fixed_text(1e300, 1), kMissing);
  EXPECT_EQ(measure_text(0), "0");
  EXPECT_EQ(measure_text(0.0123), "0.0123");
  EXPECT_EQ(measure_text(9.996), "10.0");
  EXPECT_EQ(measure_text(99.96), "100");
  EXPECT_EQ(short_text(2.3), "2.3");
  EXPECT_EQ(short_text(1.97), "1.97");
  EXPECT_EQ(count_text(940), "940");
  EXPECT_EQ(count_text(71500), "71.5 k");
  EXPECT_EQ(count_text(5400000), "5.40 M");
  EXPECT_EQ(count_text(999999), "1.00 M");
  EXPECT_EQ(bytes_text(20e9), "20.0 GB");
}

TEST(TextFormat, EscapesMarkup) {
  EXPECT_EQ(html_escape("<a href='x' b=\"&\">\x01\n"),
            "&lt;a href=&#39;x&#39; b=&quot;&amp;&quot;&gt;\n");
}

TEST(Picture, OnlyPicturesBelowTheFolder) {
  const TemporaryFolder folder;
  const std::string png = "\x89PNG\r\n\x1a\nrest";
  folder.write("pictures/a.png", png);
  folder.write("outside.png", png);
  folder.write("pictures/text.png", "not a picture");
  EXPECT_EQ(picture_data_uri(folder.path(), "pictures/a.png"),
            "data:image/png;base64,iVBORw0KGgpyZXN0");
  EXPECT_EQ(picture_data_uri(folder.path() / "pictures", "../outside.png"), "");
  EXPECT_EQ(picture_data_uri(folder.path(), (folder.path() / "outside.png").string()), "");
  EXPECT_EQ(picture_data_uri(folder.path(), "pictures/text.png"), "");
  EXPECT_EQ(picture_data_uri(folder.path(), "pictures"), "");
  EXPECT_EQ(picture_data_uri(folder.path(), "pictures/none.png"), "");
}

TEST(Chart, TicksAreNiceAndReachTheHighestValue) {
  EXPECT_EQ(nice_ticks(95), (std::vector<double>{0, 20, 40, 60, 80, 100}));
  EXPECT_EQ(nice_ticks(0), (std::vector<double>{0, 1}));
  EXPECT_EQ(nice_ticks(std::nan("")), (std::vector<double>{0, 1}));
  for (double highest = 1e-6; highest < 1e9; highest *= 1.37) {
    const auto ticks = nice_ticks(highest);
    ASSERT_GE(ticks.size(), 2U);
    EXPECT_LE(ticks.size(), 7U);
    EXPECT_GE(ticks.back(), highest * (1 - 1e-9));
    EXPECT_LT(ticks[ticks.size() - 2], highest);
    const double lead = ticks[1] / std::pow(10, std::floor(std::log10(ticks[1] * 1.0001)));
    EXPECT_TRUE(std::fabs(lead - 1) < 1e-6 || std::fabs(lead - 2) < 1e-6 ||
                std::fabs(lead - 5) < 1e-6)
        << ticks[1];
  }
}

Chart chart_of_values(const std::vector<std::optional<double>>& values) {
  Chart chart{"Title", "category", "value (cm)", {}, {{"series <1>", {std::size_t{0}, false}, {}}}};
  for (const auto& value : values) {
    chart.categories.push_back(std::string("c").append(std::to_string(chart.categories.size())));
    chart.series[0].points.push_back({value ? fixed_text(*value, 1) : kMissing, value, "", false});
  }
  return chart;
}

TEST(Chart, BarsAreAsLongAsTheirValues) {
  const std::string svg = bar_chart(chart_of_values({5, 10, std::nullopt}));
  const std::regex rect("<rect[^>]* width=\"([0-9.]+)\"");
  std::vector<double> widths;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), rect); it != std::sregex_iterator();
       ++it) {
    widths.push_back(std::stod((*it)[1]));
  }
  ASSERT_EQ(widths.size(), 2U);
  EXPECT_NEAR(widths[1] / widths[0], 2, 0.01);
  EXPECT_NE(svg.find("<title>series &lt;1&gt;, c1: 10.0; value (cm)</title>"), std::string::npos);
}

TEST(Chart, AMissingValueInterruptsTheLine) {
  const std::string svg = line_chart(chart_of_values({1, 2, std::nullopt, 3}));
  const auto line = svg.find("<path class=\"line");
  ASSERT_NE(line, std::string::npos);
  const std::string path = svg.substr(line, svg.find("/>", line) - line);
  EXPECT_EQ(count_of(path, "M"), 2U);
  EXPECT_EQ(count_of(path, "L"), 1U);
  EXPECT_EQ(count_of(svg, "<title>"), 3U);
}

TEST(Chart, DotsThatDifferMuchHaveALogarithmicAxis) {
  const std::string near = dot_chart(chart_of_values({1, 40, 7, 2}));
  EXPECT_EQ(near.find("logarithmic"), std::string::npos);
  const std::string far = dot_chart(chart_of_values({1, 10, 100, 0}));
  EXPECT_NE(far.find("value (cm), logarithmic"), std::string::npos);
  const std::regex circle("<path class=\"mark s0\" d=\"M([0-9.]+)");
  std::vector<double> xs;
  for (auto it = std::sregex_iterator(far.begin(), far.end(), circle); it != std::sregex_iterator();
       ++it) {
    xs.push_back(std::stod((*it)[1]));
  }
  ASSERT_EQ(xs.size(), 5U);  // the first is the legend's
  EXPECT_NEAR(xs[3] - xs[2], xs[2] - xs[1], 0.2);
  EXPECT_EQ(xs[4], xs[1]);  // zero is at the beginning
}

TEST(Chart, NoCategoriesAndAllZero) {
  EXPECT_EQ(line_chart(chart_of_values({})).find("nan"), std::string::npos);
  EXPECT_EQ(dot_chart(chart_of_values({})).find("nan"), std::string::npos);
  EXPECT_EQ(bar_chart(chart_of_values({0, 0})).find("nan"), std::string::npos);
}

TEST(Table, BestIsMarkedWhereValuesDifferAndTiesShareIt) {
  Table table;
  table.columns = {{"", "low", Better::lower, false}, {"", "equal", Better::lower, false}};
  table.rows = {{"a", "", {}, {{"1.0", 1.04, "", false}, {"7", 7.0, "", false}}},
                {"b", "", {}, {{"1.0", 1.01, "", false}, {"7", 7.0, "", false}}},
                {"c", "", {}, {{"2.0", 2.0, "", false}, {"–", std::nullopt, "", false}}}};
  table = with_best_marked(table);
  EXPECT_TRUE(table.rows[0].cells[0].best);
  EXPECT_TRUE(table.rows[1].cells[0].best);
  EXPECT_FALSE(table.rows[2].cells[0].best);
  EXPECT_FALSE(table.rows[0].cells[1].best);
}

// Rows that only the paper has are in a collapsed part, not among the measured rows.
TEST(ReportPage, PaperFiguresAreInACollapsedPart) {
  const std::string html = report_html(sample_results(), std::filesystem::path());
  const std::size_t opened = html.find("<details><summary>With the paper");
  ASSERT_NE(opened, std::string::npos);
  EXPECT_GT(html.find("paper only</span>"), opened);
  EXPECT_GT(html.find("RTX 2070 SUPER"), opened);
  EXPECT_NE(html.find("<h3>Models, speed and C2C</h3>"), std::string::npos);
  const std::string text = report_markdown(sample_results());
  const std::size_t details = text.find("<details><summary>With the paper");
  ASSERT_NE(details, std::string::npos);
  EXPECT_GT(text.find("(paper only)"), details);
}

TEST(ReportPage, PaperFiguresHaveColumnsNextToOurs) {
  const std::string page = report_html(sample_results(), std::filesystem::path());
  const std::string html = page.substr(page.find("<summary>With the paper"));
  const auto basic = rows_named(html, "Basic splats");
  ASSERT_FALSE(basic.empty());
  // 1.5 * 1.96 cm here, 2.3 cm in the paper; the paper's time is the best of its column.
  EXPECT_NE(basic[0].find("<td>2.94</td><td class=\"paper\">2.3</td>"), std::string::npos)
      << basic[0];
  EXPECT_NE(basic[0].find("<td>34.6</td><td class=\"paper\"><b>200</b></td>"), std::string::npos);
  const auto semantic = rows_named(html, "AdaSplats, semantic");
  EXPECT_NE(semantic.at(0).find("<b>1.96</b>"), std::string::npos) << semantic[0];
  const auto poisson = rows_named(html, "Mesh, Poisson");
  EXPECT_NE(poisson.at(0).find("out of memory"), std::string::npos);
  EXPECT_NE(poisson.at(0).find(">797<"), std::string::npos);
  EXPECT_NE(rows_named(html, "AdaSplats-KPConv").at(0).find("paper only"), std::string::npos);
  EXPECT_NE(html.find("RTX 2070 SUPER"), std::string::npos);
}

TEST(ReportPage, MeanOfThinClassesNeedsAllThree) {
  const Document document = document_of(sample_results());
  for (const Section& section : document.sections) {
    for (const Table& table : section.tables) {
      if (table.title != "With the paper’s figures: C2C of thin structures") continue;
      // Paper: (4.7 + 4.3 + 1.8) / 3 = 3.6 for semantic; basic lacks the sign.
      EXPECT_EQ(table.rows[3].cells.back().text, "3.6");
      EXPECT_EQ(table.rows[0].cells.back().text, kMissing);
      EXPECT_EQ(table.rows[0].cells[0].note, "68 pts");
      return;
    }
  }
  FAIL() << "no table of thin structures";
}

TEST(ReportPage, ClassesWithoutValuesAndFailedCompetitorsDrawNothing) {
  const std::string html = report_html(sample_results(), std::filesystem::path());
  EXPECT_EQ(html.find("moving-car"), std::string::npos);
  EXPECT_EQ(html.find("<title>Mesh, Poisson"), std::string::npos);
  EXPECT_NE(html.find("<title>Basic splats, 10-20: "), std::string::npos);
}

Json results_with(const Json& competitor) {
  Json results = sample_results();
  results["competitors"].push_back(competitor);
  return results;
}

TEST(ReportPage, AFailedCompetitorIsNeverBestAndScalesNoChart) {
  // It failed after 11 ms, faster than all others.
  Json broken = {{"name", "broken"},
                 {"title", "Broken"},
                 {"kind", "mesh"},
                 {"state", "failed"},
                 {"failed_step", "generate"},
                 {"message", "no such file"},
                 {"generate", {{"seconds", 0.0113}, {"peak_memory_bytes", 1000}}}};
  const std::string html = report_html(results_with(broken), {});
  EXPECT_EQ(html.find("0.0113"), std::string::npos);
  EXPECT_EQ(html.find("<title>Broken"), std::string::npos);
  for (const std::string& row : rows_named(html, "Broken"))
    EXPECT_EQ(row.find("<b>"), std::string::npos) << row;
  for (const Section& section : document_of(results_with(broken)).sections) {
    for (const Fact& fact : section.facts) {
      if (fact.term != "Fastest to generate") continue;
      EXPECT_EQ(fact.text, "23.0 s\nAdaSplats, semantic");
    }
  }
  EXPECT_NE(html.find("no such file"), std::string::npos);

  // It made a model and failed in a later step: its figures stay in the tables but are never best.
  Json late = sample_competitor("late", "Late", 0.001);
  late["state"] = "failed";
  late["failed_step"] = "truth";
  const Document document = document_of(results_with(late));
  const Document without = document_of(sample_results());
  for (std::size_t s = 0; s < document.sections.size(); ++s) {
    const Section& section = document.sections[s];
    if (section.id == "best") {
      ASSERT_EQ(section.facts.size(), without.sections[s].facts.size());
      for (std::size_t k = 0; k < section.facts.size(); ++k)
        EXPECT_EQ(section.facts[k].text, without.sections[s].facts[k].text);
    }
    for (const Table& table : section.tables) {
      for (const Row& row : table.rows) {
        if (row.title != "Late") continue;
        for (const Cell& cell : row.cells) EXPECT_FALSE(cell.best || cell.value) << table.title;
      }
    }
  }
  const std::string late_html = report_html(results_with(late), {});
  EXPECT_EQ(late_html.find("<title>Late"), std::string::npos);
  EXPECT_NE(rows_named(late_html, "Late").at(0).find("0.023"), std::string::npos);
}

TEST(ReportPage, ReportsFiguresOfDifferentPrograms) {
  Json results = sample_results();
  std::string text = report_markdown(results);
  EXPECT_NE(text.find("adasplats 0.1.0, commit 0123456789ab"), std::string::npos);
  EXPECT_EQ(text.find("made by different programs"), std::string::npos);
  // Merged by hand: one step of one competitor is from another build.
  results["competitors"][3]["made_by"]["c2c"]["commit"] = "fedcba9876543210";
  text = report_markdown(results);
  EXPECT_NE(text.find("made by different programs"), std::string::npos);
  EXPECT_NE(text.find("commit fedcba987654 (AdaSplats, semantic: c2c)"), std::string::npos);
  results = sample_results();
  results["competitors"][0].erase("made_by");
  EXPECT_NE(report_markdown(results).find("adasplats an unknown version (Basic splats: all)"),
            std::string::npos);
  results = sample_results();
  results["competitors"][0]["made_by"]["render"]["dirty"] = true;
  EXPECT_NE(report_markdown(results).find("0123456789ab with changes (Basic splats: render)"),
            std::string::npos);
}

TEST(ReportPage, PicturesAreEmbeddedOrNamedAsMissing) {
  const TemporaryFolder folder;
  folder.write("pictures/basic.png", "\x89PNG\r\n\x1a\nrest");
  const std::string html = report_html(sample_results(), folder.path());
  EXPECT_EQ(count_of(html, "<img "), 1U);
  EXPECT_EQ(count_of(html, "src=\"data:image/png;base64,"), 1U);
  EXPECT_NE(html.find("Picture missing: pictures/semantic.png"), std::string::npos);
}

TEST(ReportPage, AnySizeOfComparison) {
  for (const Json& none : {Json(), Json::object(), Json::array(), Json("text")})
    expect_complete(none);
  Json results = sample_results();
  expect_complete(results);
  results["competitors"] = Json::array({sample_competitor("basic", "Basic", 1)});
  expect_complete(results);
  EXPECT_EQ(report_html(results, {}).find("id=\"best\""), std::string::npos);
  results["competitors"] = Json::array();
  expect_complete(results);
  EXPECT_NE(report_html(results, {}).find("No competitor was run."), std::string::npos);
  results = sample_results();
  for (Json& competitor : results["competitors"]) {
    competitor = {{"name", competitor["name"]}, {"state", "timeout"}};
  }
  expect_complete(results);
  EXPECT_NE(report_markdown(results).find("| basic | timeout | – | – |"), std::string::npos);
}

TEST(ReportPage, AnyValueMayBeNullOrOfAnotherType) {
  Json sample = sample_results();
  sample["competitors"].erase(3);
  sample["competitors"].erase(2);
  const Json flat = sample.flatten();
  const std::array<Json, 6> others = {Json(),
                                      Json("<script>"),
                                      Json(-1e308),
                                      Json::array({1, "x"}),
                                      Json{{"k", nullptr}},
                                      Json(std::nan(""))};
  for (const auto& [pointer, value] : flat.items()) {
    Json results = sample;
    for (const Json& other : others) {
      results[Json::json_pointer(pointer)] = other;
      const std::string html = report_html(results, std::filesystem::path());
      ASSERT_EQ(html.find("<script"), std::string::npos) << pointer;
      ASSERT_EQ(count_of(html, "<tr>"), count_of(html, "</tr>")) << pointer;
      ASSERT_FALSE(report_markdown(results).empty()) << pointer;
    }
  }
}

TEST(ReportMarkdown, EveryRowHasTheColumnsOfItsTable) {
  const std::string text = report_markdown(sample_results());
  const std::regex escaped_pipe("\\\\\\|");
  std::istringstream lines(std::regex_replace(text, escaped_pipe, ""));
  std::size_t columns = 0;
  std::size_t tables = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t pipes = count_of(line, "|");
    if (!line.starts_with("|")) {
      columns = 0;
      continue;
    }
    if (columns == 0) ++tables;
    if (columns == 0) columns = pipes;
    EXPECT_EQ(pipes, columns) << line;
  }
  EXPECT_GE(tables, 10U);
  EXPECT_NE(text.find("limit \\| of 20 GB"), std::string::npos);
  EXPECT_NE(text.find("# sample &lt;street\\>"), std::string::npos);
  EXPECT_NE(text.find("](pictures/basic-c2c.png)"), std::string::npos);
}

}  // namespace
}  // namespace adasplats::page
