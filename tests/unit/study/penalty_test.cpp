// The penalty study: rows, bounds, the alpha that it recommends, its chart.
#include "solver/study/penalty/penalty.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "solver/contact/contact_law.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/common/rows.h"
#include "solver/study/penalty/penalty_chart.h"

namespace topple::study {
namespace {

using Case = PenaltyRow::Case;

/// paper-b with a slippery floor: nothing tips, so that no long run is needed.
PenaltyStudy slippery(const std::function<bool(int, int)>& go_on, int jobs = 2) {
  const io::Scene scene = io::load_scene("paper-b", {"contact.friction=0.1", "contact.q=1.2"});
  return study_penalty(scene.name, scene.title, scene.setup, {.jobs = jobs}, go_on);
}

const PenaltyStudy& complete() {
  static const PenaltyStudy study = slippery([](int, int) { return true; });
  return study;
}

TEST(PenaltyStudy, scenes_without_bodies_at_rest_on_a_plane_are_refused) {
  const auto why = [](const std::string& name, const std::vector<std::string>& overrides = {}) {
    return why_not_studied(io::load_scene(name, overrides).setup);
  };
  EXPECT_EQ(why("paper-a"), "");
  EXPECT_EQ(why("free-rocking"), "");
  EXPECT_NE(why("cantilever"), "");
  EXPECT_NE(why("tumble").find("no floor"), std::string::npos);
  EXPECT_NE(why("portal-pushover").find("not dynamic"), std::string::npos);
  EXPECT_NE(why("verify/restitution-printed").find("gravity"), std::string::npos);
  const std::string above =
      "topple = 1\n[floor]\n[[block]]\nsize = [0.2, 0.3, 0.5]\nmass = 12\nat = [0, 0, 1]\n";
  EXPECT_EQ(why_not_studied(io::parse_scene(above, "s.toml").setup),
            "has no body that stands freely on its floor");
}

TEST(PenaltyStudy, a_block_tips_and_bounces_as_a_rigid_body_on_springs) {
  const io::Scene scene =
      io::parse_scene("topple = 1\n[floor]\n[[block]]\nsize = [0.2, 0.3, 0.5]\nmass = 12\n", "block.toml");
  const PenaltyStudy study =
      study_penalty("block", "", scene.setup, {.jobs = 2}, [](int, int) { return true; });
  int seen = 0;
  for (const PenaltyRow& row : study.rows) {
    const bool tipping = row.kind == Case::tipping;
    if (!tipping && row.kind != Case::frequency && row.kind != Case::depth) continue;
    ASSERT_TRUE(row.computed) << row.status;
    // theory of tipping is of a rigid floor
    if (!tipping || row.law.alpha > 50 * study.groups[0].steady_alpha) {
      EXPECT_LT(*row.error(), 0.01) << meaning(row.kind).name << " " << row.law.alpha;
      ++seen;
    }
  }
  EXPECT_GE(seen, 10);
}

TEST(PenaltyStudy, every_number_is_a_row_with_its_case) {
  const PenaltyStudy& study = complete();
  EXPECT_EQ(study.run, study.of);
  ASSERT_EQ(study.groups.size(), 2u);
  for (const PenaltyRow& row : study.rows) {
    SCOPED_TRACE(meaning(row.kind).name);
    EXPECT_NE(row.status, "not run");
    if (row.kind == Case::force) {
      EXPECT_EQ(row.computed, penalty_force(row.law, 1 - *row.at));
    } else if (row.kind == Case::tipping || row.kind == Case::fall_back || row.kind == Case::half_sine) {
      EXPECT_EQ(row.status, "slides");
      EXPECT_FALSE(row.kept());
    }
  }
  const std::string text = csv_text(rows_as_json(study));
  EXPECT_TRUE(text.starts_with(
      "case,body,law,alpha_N,q,time_step_s,at,unit,reference,computed,error,kept,status\nforce,,coulomb,"));
}

TEST(PenaltyStudy, rest_and_bounce_agree_with_theory_where_the_body_is_stiffer_than_its_contacts) {
  int seen = 0;
  for (const PenaltyRow& row : complete().rows) {
    if ((row.kind != Case::depth && row.kind != Case::frequency) || !row.computed) continue;
    if (row.law.alpha > 2000 * k_standard_gravity || row.law.alpha < 20 * k_standard_gravity) continue;
    // a body off the middle of its contacts leans as it bounces
    EXPECT_LT(*row.error(), row.kind == Case::frequency && row.group == 0 ? 0.05 : 0.012)
        << meaning(row.kind).name << " " << row.group << " " << row.law.alpha;
    ++seen;
  }
  EXPECT_GE(seen, 20);
}

TEST(PenaltyStudy, creep_keeps_its_bound_in_every_law_but_the_printed_one) {
  int seen = 0;
  for (const PenaltyRow& row : complete().rows) {
    if (row.kind != Case::creep) continue;
    EXPECT_EQ(*row.kept(), row.law.kind != ContactLawKind::printed) << row.group;
    ++seen;
  }
  EXPECT_EQ(seen, 6);
}

TEST(PenaltyStudy, rows_are_the_same_for_any_number_of_jobs) {
  const auto some = [](int done, int) { return done < 40; };
  const PenaltyStudy one = slippery(some, 1);
  EXPECT_EQ(one.run, 40);
  std::size_t k = 0;
  for (const PenaltyRow& row : one.rows) {
    if (row.status != "not run") {
      EXPECT_EQ(row.computed, complete().rows[k].computed);
    }
    ++k;
  }
}

TEST(PenaltyStudy, the_chart_says_what_it_shows) {
  const Advice advice = advise(complete());
  EXPECT_TRUE(
      run_gnuplot(penalty_chart(complete(), advice, "topple", ChartFormat::png)).starts_with("\x89PNG"));
  const std::string svg = run_gnuplot(penalty_chart(complete(), advice, "topple {a_b} ^2", ChartFormat::svg));
  for (const char* part :
       {"Penalty contact of paper-b", "topple {a_b} ^2", "time_step 1 ms", "Force of a contact", "q = 1.2",
        "Depth at rest", "Creep at rest", "Restitution of a normal impact", "first elastic mode",
        "Error against rigid contact", "bound 2 %", "lying", "walled"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
}

TEST(PenaltyStudy, long_texts_of_the_chart_are_shortened_to_have_room) {
  PenaltyStudy hard = complete();
  EXPECT_NE(penalty_chart(hard, advise(hard), "topple", ChartFormat::svg).find("'force, N'"),
            std::string::npos);
  hard.law.alpha = 4e5;
  hard.groups[0].names = "cabinet, cabinet-2, cabinet-3, cabinet-4";
  hard.groups[0].bodies = {0, 2, 3, 4};
  const std::string chart = penalty_chart(hard, advise(hard), "topple", ChartFormat::svg);
  EXPECT_NE(chart.find("'force, kN'"), std::string::npos);
  EXPECT_NE(chart.find("cabinet and 3 more: settled"), std::string::npos);
  EXPECT_EQ(chart.find("cabinet-2: settled"), std::string::npos);
}

TEST(PenaltyStudy, the_chart_is_drawn_of_what_was_run) {
  const PenaltyStudy none = slippery([](int, int) { return false; }, 1);
  EXPECT_TRUE(
      run_gnuplot(penalty_chart(none, advise(none), "topple", ChartFormat::png)).starts_with("\x89PNG"));
  const std::string chart = penalty_chart(none, advise(none), "topple", ChartFormat::svg);
  for (const std::string& part : {std::string("no α to recommend yet, runs are missing"),
                                  fmt::format("topple, {} of {} runs", none.run, none.of)})
    EXPECT_NE(chart.find(part), std::string::npos) << part;
}

/// Rows that say of each alpha by how much the half-sine is off; all else is exact.
PenaltyStudy judged(const std::vector<std::pair<double, std::optional<double>>>& errors) {
  PenaltyStudy study = complete();
  study.groups.resize(1);
  study.law.q = 1;
  study.law.alpha = errors.front().first * k_standard_gravity;
  study.time_step = 1e-3;
  study.rows.clear();
  study.alphas.clear();
  for (const auto& [kgf, error] : errors) {
    ContactLaw law = study.law;
    law.alpha = kgf * k_standard_gravity;
    study.alphas.push_back(law.alpha);
    for (const Case kind : {Case::depth, Case::tipping, Case::fall_back, Case::half_sine}) {
      PenaltyRow row{.kind = kind, .group = 0, .law = law, .at = 4, .reference = 0.005, .computed = 0.005};
      row.status = "completed";
      if (kind == Case::half_sine) {
        row.computed.reset();
        if (error) row.computed = 0.005 * (1 - *error);
        if (!error) row.status = "not run";
      }
      study.rows.push_back(row);
    }
  }
  return study;
}

double in_kgf(const Advice& advice) {
  return advice.alpha.value_or(0) / k_standard_gravity;
}

TEST(PenaltyAdvice, is_the_smallest_alpha_from_which_every_bound_is_kept) {
  const Advice advice = advise(judged({{50, 0.3}, {1000, 0.021}, {2000, 0.019}, {5000, 0.01}}));
  EXPECT_NEAR(in_kgf(advice), 2000, 1e-6);
  EXPECT_EQ(advice.of_scene.missed, (std::vector<std::string>{"half-sine (w/p = 4) 30 % low"}));
  EXPECT_FALSE(advice.of_default.good());
  // a bound that is kept by chance between two that are not
  EXPECT_NEAR(in_kgf(advise(judged({{50, 0.01}, {1000, 0.03}, {2000, 0.01}, {5000, 0.01}}))), 2000, 1e-6);
}

TEST(PenaltyAdvice, is_none_where_no_alpha_will_do_or_runs_are_missing) {
  const Advice none = advise(judged({{50, 0.3}, {1000, 0.2}, {2000, 0.1}}));
  EXPECT_FALSE(none.alpha);
  EXPECT_FALSE(none.undecided);
  EXPECT_NE(none.reasons.front().find("No alpha from 50 kgf to 2000 kgf"), std::string::npos);
  const Advice missing = advise(judged({{50, 0.3}, {1000, 0.2}, {2000, {}}}));
  EXPECT_FALSE(missing.alpha);
  EXPECT_TRUE(missing.undecided);
  EXPECT_EQ(missing.reasons.front(), "Runs are missing that would decide it.");
}

TEST(PenaltyAdvice, tells_the_step_that_resolves_the_bounce) {
  const Advice soft = advise(judged({{1000, 0.01}, {2000, 0.01}}));
  EXPECT_TRUE(soft.resolved);
  EXPECT_EQ(soft.time_step, 1e-3);
  const Advice stiff = advise(judged({{1000, 0.1}, {20000, 0.01}}));
  EXPECT_FALSE(stiff.resolved);
  EXPECT_NEAR(*stiff.time_step, 1e-3 * 7.326 / 20, 1e-6);
}

TEST(PenaltyAdvice, alphas_are_named_in_kgf) {
  EXPECT_EQ(kgf_text(50 * k_standard_gravity), "50 kgf");
  EXPECT_EQ(kgf_text(20000 * k_standard_gravity), "20000 kgf");
  EXPECT_EQ(kgf_text(1163.43 * k_standard_gravity), "1163 kgf");
  EXPECT_EQ(kgf_text(0.001 * k_standard_gravity), "0.001 kgf");
}

}  // namespace
}  // namespace topple::study
