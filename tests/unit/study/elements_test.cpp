// The benchmarks of the element comparison: what theory says of each scheme.
#include "solver/study/elements/elements.h"

#include <gtest/gtest.h>
#include <string>
#include <string_view>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "solver/io/scene/scene.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/common/rows.h"
#include "solver/study/elements/elements_chart.h"

namespace topple::study {
namespace {

bool always(int, int) {
  return true;
}

const ElementsStudy& solved() {
  static const ElementsStudy study = study_elements({.jobs = 2, .timed = 0}, always);
  return study;
}

const ElementsRow& row(std::string_view quantity, Scheme scheme, int elements_per_member) {
  for (const ElementsRow& found : solved().rows)
    if (found.quantity == quantity && found.scheme == scheme &&
        found.elements_per_member == elements_per_member)
      return found;
  throw std::out_of_range(std::string(quantity));
}

double error(const std::string& quantity, Scheme scheme, int elements_per_member) {
  return row(quantity, scheme, elements_per_member).error.value();
}

/// Order of convergence between n/2 and n elements per member.
double order(const std::string& quantity, Scheme scheme, int n) {
  return std::log2(error(quantity, scheme, n / 2) / error(quantity, scheme, n));
}

TEST(ElementsStudy, every_solution_is_found) {
  EXPECT_EQ(solved().of, 7 * 3 * 6);
  EXPECT_EQ(solved().solved, solved().of);
  EXPECT_EQ(solved().rows.size(), 11u * 3 * 6);
  for (const ElementsRow& found : solved().rows) {
    SCOPED_TRACE(found.quantity + " " + traits(found.scheme).word);
    EXPECT_EQ(found.status, "completed");
    EXPECT_TRUE(found.computed && found.error && found.cpu);
    EXPECT_GE(found.elements, found.elements_per_member);
    EXPECT_GT(found.unknowns, 0);
  }
  EXPECT_EQ(row("cantilever", Scheme::asi, 4).unknowns, 24);
  EXPECT_EQ(row("cabinet-frequency-1", Scheme::asi, 2).elements, 24);
}

TEST(ElementsStudy, asi_gauss_is_exact_where_loads_act_on_member_ends) {
  for (const int n : k_elements_per_member) {
    SCOPED_TRACE(n);
    EXPECT_LT(error("cantilever", Scheme::asi_gauss, n), 1e-13);
    EXPECT_LT(error("portal-sway", Scheme::asi_gauss, n), 1e-9);
  }
}

TEST(ElementsStudy, hinges_at_element_ends_give_exact_collapse_loads) {
  for (const Scheme scheme : {Scheme::asi_gauss, Scheme::asi})
    for (const int n : k_elements_per_member) {
      SCOPED_TRACE(traits(scheme).word + (" " + std::to_string(n)));
      EXPECT_LT(error("beam-collapse", scheme, n), 1e-9);
      // 2e-6 is the change of shape. One load step of the portal of two asi elements stands out by 2e-5.
      const bool stands_out = scheme == Scheme::asi && n == 2;
      EXPECT_LT(error("portal-collapse", scheme, n), stands_out ? 2e-5 : 2e-6);
      // sway and normal forces take 2e-5 off
      EXPECT_LT(error("portal-corners", scheme, n), 5e-5);
    }
}

TEST(ElementsStudy, midpoint_collapse_load_is_too_high_by_n_over_n_minus_one) {
  for (const double n : k_elements_per_member) {
    const ElementsRow& found = row("beam-collapse", Scheme::midpoint, static_cast<int>(n));
    EXPECT_NEAR(*found.computed / found.reference / (n / (n - 1)), 1, 1e-9) << n;
  }
}

TEST(ElementsStudy, midpoint_elements_converge_with_the_order_of_theory) {
  for (const Benchmark& benchmark : solved().benchmarks)
    for (const Quantity& quantity : benchmark.quantities)
      EXPECT_NEAR(order(quantity.name, Scheme::midpoint, 64), quantity.order, 0.04) << quantity.name;
  for (const int n : {4, 8, 16, 32}) EXPECT_NEAR(order("cantilever", Scheme::midpoint, n), 2, 1e-6) << n;
}

TEST(ElementsStudy, frequencies_and_the_elastica_converge_with_second_order_in_asi_gauss) {
  for (const char* quantity : {"elastica-deflection", "elastica-angle", "cabinet-frequency-1",
                               "cabinet-frequency-2", "cabinet-frequency-3"})
    EXPECT_NEAR(order(quantity, Scheme::asi_gauss, 64), 2, 0.03) << quantity;
}

TEST(ElementsStudy, without_hinges_asi_is_the_midpoint_element) {
  for (const char* quantity : {"cantilever", "elastica-deflection", "portal-sway", "cabinet-frequency-3"})
    for (const int n : k_elements_per_member)
      EXPECT_EQ(*row(quantity, Scheme::asi, n).computed, *row(quantity, Scheme::midpoint, n).computed);
}

TEST(ElementsStudy, references_by_extrapolation_are_far_better_than_what_they_judge) {
  std::map<std::string, double> least;
  for (const ElementsRow& found : solved().rows) {
    double& best = least.try_emplace(found.quantity, 1.).first->second;
    best = std::min(best, *found.error);
  }
  for (const Quantity& quantity : solved().benchmarks.back().quantities) {
    EXPECT_GT(quantity.uncertainty, 0) << quantity.name;
    EXPECT_LT(quantity.uncertainty, 1e-2 * least[quantity.name]) << quantity.name;
  }
}

TEST(ElementsStudy, rows_are_the_same_for_any_number_of_jobs) {
  nlohmann::ordered_json one = rows_as_json(study_elements({.jobs = 1, .timed = 0}, always));
  nlohmann::ordered_json two = rows_as_json(solved());
  for (nlohmann::ordered_json* rows : {&one, &two})
    for (auto& found : *rows) found.erase("cpu_s");
  EXPECT_EQ(csv_text(one), csv_text(two));
}

TEST(ElementsStudy, csv_has_a_line_a_row_under_fixed_names) {
  const std::string text = csv_text(rows_as_json(solved()));
  EXPECT_TRUE(text.starts_with(
      "case,scheme,elements_per_member,elements,unknowns,unit,reference,computed,error,cpu_s,"
      "status\ncantilever,asi-gauss,2,2,12,m,"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 199);
}

TEST(ElementsStudy, what_time_did_not_allow_is_a_row_that_says_so) {
  const ElementsStudy part = study_elements({.timed = 0}, [](int done, int) { return done < 21; });
  EXPECT_EQ(part.solved, 21);
  EXPECT_EQ(part.rows.size(), solved().rows.size());
  for (const ElementsRow& found : part.rows) {
    EXPECT_EQ(found.status, found.elements_per_member == 2 ? "completed" : "not run");
    EXPECT_EQ(found.error.has_value(), found.elements_per_member == 2);
  }
  EXPECT_NE(csv_text(rows_as_json(part)).find(",,,,not run\n"), std::string::npos);
  EXPECT_TRUE(run_gnuplot(elements_chart(part, "part", ChartFormat::png)).starts_with("\x89PNG"));
}

TEST(ElementsStudy, charts_are_drawn_and_say_what_they_show) {
  EXPECT_TRUE(run_gnuplot(elements_chart(solved(), "topple", ChartFormat::png)).starts_with("\x89PNG"));
  const std::string svg = run_gnuplot(elements_chart(solved(), "topple {a_b} ^2", ChartFormat::svg));
  EXPECT_TRUE(svg.starts_with("<?xml"));
  for (const char* part : {"Error of three beam schemes", "topple {a_b} ^2", "ASI-Gauss", "CPU time, ms",
                           "elements per member", "relative error", "Richardson", "8 Mp/L"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
}

TEST(ElementsStudy, benchmarks_are_scenes_that_can_be_run_by_name) {
  for (const Benchmark& benchmark : solved().benchmarks)
    EXPECT_NO_THROW(io::load_scene(benchmark.scene)) << benchmark.scene;
  EXPECT_EQ(io::study_scenes().size(), solved().benchmarks.size());
}

}  // namespace
}  // namespace topple::study
