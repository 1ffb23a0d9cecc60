#include "app/picture/bridge.h"
#include "app/furnish/room_picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/picture/anchor_picture.h"
#include "app/picture/annotations.h"
#include "app/picture/solid_bodies.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "solver/body/anchors.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using render::Float3;

class BridgeTest : public ::testing::Test {
 protected:
  BridgeTest() : scene_(io::parse_scene(k_shaken, "s.toml")), run_(scene_.setup) {
    start_ = io::frame_row(run_);
    extent_.add(scene_.setup, scene_.setup.parameters, start_);
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(run_.advance().ok());
    end_ = io::frame_row(run_);
    extent_.add(scene_.setup, scene_.setup.parameters, end_);
  }
  const Model& model() const { return scene_.setup.model; }
  static double distance(const Float3& a, const Vec3& b) { return (Vec3(a[0], a[1], a[2]) - b).norm(); }
  static Vec3 seen(const io::FrameRow& row, int node) {
    return Vec3(row.position[3 * node], row.position[3 * node + 1], row.position[3 * node + 2]) +
           Vec3(row.floor_displacement);
  }

  io::Scene scene_;
  topple::Run run_;
  io::FrameRow start_, end_;
  RunExtent extent_;
};

TEST_F(BridgeTest, members_are_drawn_from_their_first_to_their_last_node) {
  const render::SceneFrame frame = Bridge(scene_, extent_).frame(end_, scene_.setup.parameters);
  ASSERT_EQ(frame.tubes.size(), model().members.size());
  for (std::size_t m = 0; m < frame.tubes.size(); ++m) {
    const Member& member = model().members[m];
    const render::Tube& tube = frame.tubes[m];
    const Element& first = model().elements[member.first_element];
    const Element& last = model().elements[member.first_element + member.element_count - 1];
    EXPECT_LT(distance(frame.stations[tube.first_station].position, seen(end_, first.node[0])), 1e-6);
    EXPECT_LT(distance(frame.stations[tube.first_station + tube.station_count - 1].position,
                       seen(end_, last.node[1])),
              1e-6);
    EXPECT_EQ(tube.member, m);
    EXPECT_LT(tube.profile, frame.profiles.size());
  }
}

TEST_F(BridgeTest, of_a_row_that_is_not_finite_nothing_is_drawn_but_the_floor) {
  PictureSettings settings;
  settings.contact_forces = settings.panels = true;
  settings.trails = Trails::run;
  const Bridge bridge(scene_, extent_);
  const auto expect_clean = [&](const io::FrameRow& row) {
    render::SceneFrame frame = bridge.frame(row, scene_.setup.parameters, settings);
    bridge.add_ghost(row, row, settings, frame);
    EXPECT_TRUE(frame.tubes.empty() && frame.stations.empty() && frame.ghost_stations.empty());
    EXPECT_TRUE(frame.panels.empty() && frame.arrows.empty() && frame.rings.empty());
    EXPECT_FALSE(frame.grounds.empty());
    for (const render::Ground& ground : frame.grounds)
      for (const Float3& v : {ground.centre, ground.normal, ground.along})
        for (const float x : v) EXPECT_TRUE(std::isfinite(x));
    ASSERT_EQ(frame.caption.lines.size(), 1u);
    EXPECT_EQ(frame.caption.lines[0], "not drawn: a number of this instant is not finite");
    EXPECT_EQ(frame.caption.note, "");
  };
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const auto each = [&](auto field) {
      for (std::size_t k = 0; k < std::size(end_.*field); k += 7) {
        io::FrameRow row = end_;
        (row.*field)[k] = static_cast<std::decay_t<decltype((row.*field)[k])>>(bad);
        expect_clean(row);
      }
    };
    each(&io::FrameRow::position);
    each(&io::FrameRow::rotation);
    each(&io::FrameRow::section_force);
    each(&io::FrameRow::s);
    each(&io::FrameRow::contact_depth);
    each(&io::FrameRow::contact_force);
    each(&io::FrameRow::member_contact);
    each(&io::FrameRow::energy);
    for (double io::BodyNumbers::*number : {&io::BodyNumbers::x, &io::BodyNumbers::tilt}) {
      io::FrameRow row = end_;
      row.body[0].*number = bad;
      expect_clean(row);
    }
    each(&io::FrameRow::floor_acceleration);
    each(&io::FrameRow::floor_displacement);
    for (double io::FrameRow::*number : {&io::FrameRow::time, &io::FrameRow::load_factor}) {
      io::FrameRow row = end_;
      row.*number = bad;
      expect_clean(row);
    }
  }
}

TEST_F(BridgeTest, a_hinge_is_a_ring_at_its_end_and_a_broken_element_is_open) {
  const std::size_t whole = Bridge(scene_, extent_).frame(end_, scene_.setup.parameters).tubes.size();
  io::FrameRow row = end_;
  row.hinge[0] = 1;
  row.hinge[3] = 2;
  const render::SceneFrame hinged = Bridge(scene_, extent_).frame(row, scene_.setup.parameters);
  ASSERT_EQ(hinged.rings.size(), 2u);
  EXPECT_LT(distance(hinged.rings[0].centre, seen(row, model().elements[0].node[0])), 1e-6);
  EXPECT_LT(distance(hinged.rings[1].centre, seen(row, model().elements[3].node[1])), 1e-6);
  EXPECT_EQ(hinged.tubes.size(), whole);
  EXPECT_TRUE(hinged.rings[0].turns);
  row.hinge[0] = io::k_flowed_first;
  EXPECT_FALSE(Bridge(scene_, extent_).frame(row, scene_.setup.parameters).rings[0].turns);
  row.hinge[0] = 1;

  row.hinge[3] = 3;
  const render::SceneFrame broken = Bridge(scene_, extent_).frame(row, scene_.setup.parameters);
  EXPECT_EQ(broken.rings.size(), 1u);
  ASSERT_EQ(broken.tubes.size(), whole + 1);
  const std::size_t member = static_cast<std::size_t>(model().elements[3].member);
  const render::Tube& one = broken.tubes[member];
  const render::Tube& other = broken.tubes[member + 1];
  EXPECT_EQ(one.member, other.member);
  const auto& end = broken.stations[one.first_station + one.station_count - 1].position;
  const auto& begin = broken.stations[other.first_station].position;
  EXPECT_NEAR(distance(end, Vec3(begin[0], begin[1], begin[2])), 0.2 * model().elements[3].length, 1e-4);
  EXPECT_GT(one.torn_last, 0);
  EXPECT_GT(other.torn_first, 0);
  EXPECT_EQ(one.torn_first, 0);
  EXPECT_EQ(other.torn_last, 0);
}

// What tells the states of an anchor apart is their shape: straight from end to end, hanging, or in two.
TEST(AnchorPicture, shows_whether_it_holds_sags_broke_or_is_away) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  const Model& model = scene.setup.model;
  const topple::Run run(scene.setup);
  io::FrameRow row = io::frame_row(run);
  RunExtent extent;
  extent.add(scene.setup, scene.setup.parameters, row);
  const auto drawn = [&](float state) {
    row.anchor[1].state = state;
    render::SceneFrame frame = Bridge(scene, extent).frame(row, scene.setup.parameters);
    std::erase_if(frame.tubes,
                  [&](const render::Tube& tube) { return tube.member != model.members.size() + 1; });
    return frame;
  };
  const auto place = [](const render::SceneFrame& frame, const render::Tube& tube, std::uint32_t i) {
    const Float3& x = frame.stations[tube.first_station + i].position;
    return Vec3(x[0], x[1], x[2]);
  };
  const Vec3 to = model.anchors[1].to, at = anchor_point(model, run.state(), 1).at;
  const render::SceneFrame holds = drawn(io::k_anchor_holds);
  ASSERT_EQ(holds.tubes.size(), 3u);  // two end marks and the strap
  const render::Tube& strap = holds.tubes[2];
  EXPECT_LT((place(holds, strap, 0) - to).norm(), 1e-5);
  EXPECT_LT((place(holds, strap, strap.station_count - 1) - at).norm(), 1e-5);

  const render::SceneFrame slack = drawn(io::k_anchor_slack);
  ASSERT_EQ(slack.tubes.size(), 3u);
  const render::Tube& loose = slack.tubes[2];
  const Vec3 middle = place(slack, loose, loose.station_count / 2);
  EXPECT_GT((middle - (to + at) / 2).norm(), 0.1 * (at - to).norm());
  EXPECT_NE(loose.colour, strap.colour);

  const render::SceneFrame broken = drawn(io::k_anchor_broken);
  ASSERT_EQ(broken.tubes.size(), 4u);
  EXPECT_LT((place(broken, broken.tubes[2], 0) - to).norm(), 1e-5);
  EXPECT_LT((place(broken, broken.tubes[3], 0) - at).norm(), 1e-5);
  EXPECT_GT((place(broken, broken.tubes[2], 1) - place(broken, broken.tubes[3], 1)).norm(),
            0.1 * (at - to).norm());

  render::SceneFrame furnished = start_frame(scene);
  std::erase_if(furnished.tubes,
                [&](const render::Tube& tube) { return tube.member != model.members.size() + 1; });
  ASSERT_EQ(furnished.tubes.size(), 3u);
  const render::Tube& in_room = furnished.tubes[2];
  const Vec3 mark = (place(furnished, furnished.tubes[1], 0) + place(furnished, furnished.tubes[1], 1)) / 2;
  EXPECT_LT((place(furnished, in_room, in_room.station_count - 1) - mark).norm(), 1e-5);

  EXPECT_EQ(drawn(io::k_anchor_away).tubes.size(), 0u);
  EXPECT_EQ(anchor_in_words(model, row, 1), "strap strong: taken away");
  row.anchor[0].tension = 0.5f;
  row.anchor[0].state = io::k_anchor_holds;
  EXPECT_EQ(anchor_in_words(model, row, 0), "strap weak: pulls 0 N, 50 % of its strength");
  Model called_by_type = model;
  called_by_type.anchors[1].name = "strap";
  EXPECT_EQ(anchor_in_words(called_by_type, row, 1), "strap: taken away");
}

// A pole that its piece fell away from, and what broke, hold nothing any more: they are grey, and stubs.
TEST(AnchorPicture, what_holds_nothing_any_more_is_grey) {
  io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  scene.setup.model.anchors[1].type = Anchor::Type::pole;
  const topple::Run run(scene.setup);
  io::FrameRow row = io::frame_row(run);
  const auto drawn = [&](float state) {
    row.anchor[1].state = state;
    render::SceneFrame frame;
    add_anchors(scene.setup.model, row, Vec3::Zero(), frame);
    std::erase_if(frame.tubes, [&](const render::Tube& tube) {
      return tube.member != scene.setup.model.members.size() + 1;
    });
    return frame;
  };
  const auto is_grey = [](const render::Tube& tube) {
    return tube.colour[0] == tube.colour[1] && tube.colour[1] == tube.colour[2];
  };
  EXPECT_TRUE(std::ranges::none_of(drawn(io::k_anchor_holds).tubes, is_grey));
  EXPECT_TRUE(std::ranges::all_of(drawn(io::k_anchor_slack).tubes, is_grey));
  const render::SceneFrame broken = drawn(io::k_anchor_broken);
  ASSERT_EQ(broken.tubes.size(), 4u);
  EXPECT_TRUE(std::ranges::all_of(broken.tubes, is_grey));
  for (const std::size_t stub : {2u, 3u}) {
    const auto& a = broken.stations[broken.tubes[stub].first_station].position;
    const auto& b = broken.stations[broken.tubes[stub].first_station + 1].position;
    EXPECT_LT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 0.1);
  }
}

TEST_F(BridgeTest, pictures_hold_finite_numbers_within_their_bounds) {
  const render::SceneFrame frame = Bridge(scene_, extent_).frame(end_, scene_.setup.parameters);
  for (const render::Station& station : frame.stations) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(station.position[k], frame.bounds_min[k]);
      EXPECT_LE(station.position[k], frame.bounds_max[k]);
    }
    EXPECT_TRUE(std::isfinite(station.value));
    EXPECT_GE(station.value, 0);
    double square = 0;
    for (const float q : station.rotation) square += static_cast<double>(q) * static_cast<double>(q);
    EXPECT_NEAR(square, 1, 1e-5);
  }
  EXPECT_GT(frame.legend.maximum, 0);
  EXPECT_EQ(frame.trace.at.size(), 2u);
  EXPECT_FLOAT_EQ(frame.trace.cursor, 0.1f);
}

TEST(RoomPicture, shows_doors_in_their_walls_and_places_on_the_floor) {
  const io::Scene scene = io::load_scene("classroom");
  const Room& room = scene.setup.room;
  const topple::Run run(scene.setup);
  const io::FrameRow row = io::frame_row(run);
  RunExtent extent;
  extent.add(scene.setup, scene.setup.parameters, row);
  const Bridge bridge(scene, extent);
  const render::SceneFrame frame = bridge.frame(row, scene.setup.parameters);
  std::vector<std::string> words;
  for (const render::Label& label : frame.labels) words.push_back(label.words);
  EXPECT_EQ(words, (std::vector<std::string>{"front door", "back door", "teacher", "aisle", "back row"}));
  for (std::size_t d = 0; d < room.doors.size(); ++d) {
    const auto& corners = frame.panels[d].corners;
    const Room::Wall& wall = room.walls[static_cast<std::size_t>(room.doors[d].wall)];
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(Room::before(wall, {corners[k][0], corners[k][1]}), 0.005, 1e-6);
      EXPECT_FLOAT_EQ(corners[k][2], k < 2 ? 0 : 2);
    }
    EXPECT_NEAR(std::hypot(corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]), 0.9, 1e-6);
  }
  ASSERT_EQ(frame.rings.size(), 3u);
  EXPECT_FLOAT_EQ(frame.rings[0].radius, 0.25f);
  EXPECT_EQ(frame.rings[0].centre, (Float3{3, 0, 0}));
  PictureSettings settings;
  settings.words = false;
  EXPECT_TRUE(bridge.frame(row, scene.setup.parameters, settings).labels.empty());
}

TEST(StaticBridge, pictures_of_a_static_run_tell_load_step_and_load_factor) {
  const io::Scene scene = io::load_scene("portal-pushover");
  topple::Run run(scene.setup);
  RunExtent extent;
  io::FrameRow row;
  for (int k = 0; k < 3; ++k) {
    if (k > 0) {
      ASSERT_TRUE(run.advance().ok());
    }
    row = io::frame_row(run);
    extent.add(scene.setup, scene.setup.parameters, row);
  }
  const render::SceneFrame frame = Bridge(scene, extent).frame(row, scene.setup.parameters);
  EXPECT_EQ(frame.caption.lines.front(),
            fmt::format("load step 2 of 40, load factor {:.4g}", run.state().load_factor));
  EXPECT_EQ(frame.trace.label, "load factor");
  EXPECT_EQ(frame.trace.unit, "load steps");
  EXPECT_EQ(frame.trace.at, (std::vector<float>{0, 1, 2}));
  ASSERT_EQ(frame.trace.value.size(), 3u);
  EXPECT_FLOAT_EQ(frame.trace.value[2], static_cast<float>(run.state().load_factor));
  EXPECT_FLOAT_EQ(frame.trace.cursor, 2);
  EXPECT_GT(run.state().load_factor, 0.1);  // the loads move 3 mm
}

// Pushed along x, the columns of a portal turn about their feet from z towards x: about +y, whichever of
// their ends the foot is.
TEST(StaticBridge, rings_of_hinges_turn_as_their_elements_do) {
  const io::Scene scene = io::load_scene("portal-pushover");
  topple::Run run(scene.setup);
  RunExtent extent;
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const io::FrameRow row = io::frame_row(run);
  extent.add(scene.setup, scene.setup.parameters, row);
  const render::SceneFrame frame = Bridge(scene, extent).frame(row, scene.setup.parameters);
  int feet = 0;
  for (const render::Ring& ring : frame.rings) {
    if (!ring.turns || ring.centre[2] > 0.1f) continue;
    ++feet;
    EXPECT_GT(ring.axis[1], 0.9f * std::hypot(ring.axis[0], ring.axis[1], ring.axis[2]));
  }
  EXPECT_EQ(feet, 2);
}

TEST_F(BridgeTest, the_floor_moves_under_the_picture_with_its_displacement) {
  io::FrameRow moved = end_;
  moved.floor_displacement[0] += 0.25;
  const Bridge bridge(scene_, extent_);
  const render::SceneFrame before = bridge.frame(end_, scene_.setup.parameters),
                           after = bridge.frame(moved, scene_.setup.parameters);
  ASSERT_EQ(after.grounds.size(), 1u);
  EXPECT_TRUE(after.grounds[0].is_floor);
  EXPECT_NEAR(after.grounds[0].centre[0] - before.grounds[0].centre[0], 0.25, 1e-6);
  EXPECT_NEAR(after.stations[0].position[0] - before.stations[0].position[0], 0.25, 1e-6);
}

TEST_F(BridgeTest, captions_tell_a_tilt_from_the_critical_angle) {
  io::FrameRow row = end_;
  row.body[0].tilt = 34.8 / k_degrees;
  row.body[0].slide = 0;
  row.body[0].critical_angle = 10.3 / k_degrees;
  const Vec3& gravity = scene_.setup.parameters.gravity;
  row.body[0].energy += 1;  // J, of motion
  EXPECT_EQ(body_in_words(model(), gravity, row, 0), "free: beyond critical, 34.8° of 10.3°");
  row.body[0].energy -= io::kinetic_energy(model(), gravity, row, 0);
  EXPECT_EQ(body_in_words(model(), gravity, row, 0), "free: tipped, rests at 34.8° (critical 10.3°)");
}

TEST_F(BridgeTest, captions_say_time_excitation_and_tilt) {
  const render::Caption caption = Bridge(scene_, extent_).frame(end_, scene_.setup.parameters).caption;
  EXPECT_EQ(caption.title, "A cabinet for tests");
  ASSERT_EQ(caption.lines.size(), 3u);
  EXPECT_EQ(caption.lines[0], "t = 0.10 s");
  EXPECT_TRUE(caption.lines[1].starts_with("floor: 2 Hz, 400 gal;  now ")) << caption.lines[1];
  EXPECT_TRUE(caption.lines[2].starts_with("free: leans ")) << caption.lines[2];
}

TEST_F(BridgeTest, captions_have_no_minus_before_a_zero) {
  io::FrameRow row = end_;
  row.floor_acceleration[0] = -1e-4;
  row.floor_displacement[0] = -1e-6;
  const render::Caption caption = Bridge(scene_, extent_).frame(row, scene_.setup.parameters).caption;
  EXPECT_EQ(caption.lines[1], "floor: 2 Hz, 400 gal;  now +0 gal, +0 mm");
}

TEST_F(BridgeTest, a_row_of_another_model_is_refused) {
  io::FrameRow foreign = end_;
  foreign.position.resize(foreign.position.size() - 3);
  EXPECT_THROW(extent_.add(scene_.setup, scene_.setup.parameters, foreign), io::InputError);
}

TEST_F(BridgeTest, blends_begin_and_end_in_their_rows_and_stay_between_them) {
  EXPECT_EQ(blend(start_, end_, start_.time).position, start_.position);
  EXPECT_EQ(blend(start_, end_, end_.time).position, end_.position);
  EXPECT_EQ(blend(start_, end_, -1).position, start_.position);
  EXPECT_EQ(blend(start_, start_, 0).position, start_.position);
  const io::FrameRow half = blend(start_, end_, 0.05);
  EXPECT_EQ(half.time, 0.05);
  for (std::size_t i = 0; i < half.position.size(); ++i)
    EXPECT_NEAR(half.position[i], (start_.position[i] + end_.position[i]) / 2, 1e-6);
  for (std::size_t i = 0; i < half.rotation.size(); i += 4) {
    double square = 0;
    for (std::size_t k = 0; k < 4; ++k) square += std::pow(half.rotation[i + k], 2);
    EXPECT_NEAR(square, 1, 1e-6);
  }
}

TEST_F(BridgeTest, the_colour_scale_ends_below_a_rare_peak) {
  RunExtent extent;
  for (int i = 0; i < 100; ++i) extent.add(scene_.setup, scene_.setup.parameters, start_);
  const double usual = extent.top(BeamQuantity::stress);
  io::FrameRow peak = start_;
  for (float& force : peak.section_force) force = 1e6f;
  extent.add(scene_.setup, scene_.setup.parameters, peak);
  EXPECT_EQ(extent.top(BeamQuantity::stress), usual);
  EXPECT_EQ(RunExtent().top(BeamQuantity::stress), 0);
}

TEST_F(BridgeTest, ranges_end_at_this_instant_at_the_run_or_at_a_number) {
  const Bridge bridge(scene_, extent_);
  const auto legend = [&](const io::FrameRow& row, const PictureSettings& settings) {
    return bridge.frame(row, scene_.setup.parameters, settings).legend;
  };
  const auto end = [](double top) { return top > 0 ? std::max(top, 1e-3) : 1; };
  for (const BeamQuantityTraits& quantity : beam_quantities()) {
    const double unit = quantity.per_unit;
    SCOPED_TRACE(quantity.word);
    PictureSettings settings{.colour = quantity.kind, .range = RangePolicy::run};
    EXPECT_FLOAT_EQ(legend(end_, settings).maximum,
                    static_cast<float>(end(extent_.top(quantity.kind) / unit)));
    EXPECT_EQ(legend(start_, settings).maximum, legend(end_, settings).maximum);
    settings.range = RangePolicy::instant;
    const render::SceneFrame frame = bridge.frame(end_, scene_.setup.parameters, settings);
    float most = 0;
    for (const render::Station& station : frame.stations) most = std::max(most, std::abs(station.value));
    // stresses are greatest at element ends, where stations lie; displacements at nodes, or a little beyond
    EXPECT_NEAR(frame.legend.maximum, end(most), 0.15 * frame.legend.maximum + 1e-6);
    settings.range = RangePolicy::fixed;
    settings.maximum = 7.5;
    EXPECT_EQ(legend(end_, settings).maximum, 7.5f);
    EXPECT_EQ(legend(end_, settings).minimum, quantity.is_signed ? -7.5f : 0.f);
    EXPECT_EQ(legend(end_, settings).is_signed, quantity.is_signed);
  }
}

TEST_F(BridgeTest, legends_mark_yield_and_say_what_else_is_not_as_it_is) {
  const auto notes = [](const io::Scene& scene, const RunExtent& extent, const io::FrameRow& row,
                        const PictureSettings& settings) {
    return Bridge(scene, extent).frame(row, scene.setup.parameters, settings).legend;
  };
  EXPECT_TRUE(notes(scene_, extent_, end_, {}).notes.empty());
  EXPECT_EQ(notes(scene_, extent_, end_, {}).mark_label, "");
  EXPECT_EQ(notes(scene_, extent_, end_, {.exaggeration = 20}).notes.at(0), "deformation ×20");
  EXPECT_EQ(notes(scene_, extent_, end_, {.colour = BeamQuantity::yield_ratio}).notes.at(0),
            "nothing here can yield");
  EXPECT_TRUE(notes(scene_, extent_, end_, {.contact_forces = true}).notes.at(0).starts_with("arrows: "));
  const io::Scene yields = io::load_scene("yielding");
  const io::FrameRow row = io::frame_row(topple::Run(yields.setup));
  RunExtent extent;
  extent.add(yields.setup, yields.setup.parameters, row);
  EXPECT_EQ(notes(yields, extent, row, {}).mark_label, "yield 235 MPa");
  EXPECT_FLOAT_EQ(notes(yields, extent, row, {}).mark, 235);
  EXPECT_EQ(notes(yields, extent, row, {.colour = BeamQuantity::yield_ratio}).mark, 1);
}

// The sum of what the floor does to a body at rest is its weight; forces too small to be seen are left out.
TEST_F(BridgeTest, arrows_of_a_resting_body_add_up_to_its_weight) {
  const Bridge bridge(scene_, extent_);
  const render::SceneFrame frame = bridge.frame(start_, scene_.setup.parameters, {.contact_forces = true});
  ASSERT_FALSE(frame.arrows.empty());
  double sum = 0;
  for (const render::Arrow& arrow : frame.arrows) sum += arrow.to[2] - arrow.from[2];
  const double weight = model().bodies[0].mass * scene_.setup.parameters.gravity.norm();
  EXPECT_NEAR(sum * newtons_per_decimetre(extent_) / 0.1, weight, 0.01 * weight);
  EXPECT_TRUE(bridge.frame(start_, scene_.setup.parameters).arrows.empty());
}

TEST_F(BridgeTest, arrows_of_a_blow_have_the_scale_of_the_run_and_in_a_picture_alone_one_that_fits) {
  RunExtent extent;
  for (int i = 0; i < 100; ++i) extent.add(scene_.setup, scene_.setup.parameters, start_);
  io::FrameRow blow = start_;
  for (float& force : blow.contact_force) force *= 50;
  extent.add(scene_.setup, scene_.setup.parameters, blow);
  const Bridge bridge(scene_, extent);
  const auto frame = [&](const io::FrameRow& row, bool alone) {
    return bridge.frame(row, scene_.setup.parameters, {.contact_forces = true, .alone = alone});
  };
  const std::vector<std::string> usual = frame(start_, false).legend.notes;
  EXPECT_EQ(frame(blow, false).legend.notes, usual);
  EXPECT_EQ(frame(start_, true).legend.notes, usual);
  const render::SceneFrame struck = frame(blow, true);
  EXPECT_NE(struck.legend.notes, usual);
  double longest = 0;
  for (const render::Arrow& arrow : struck.arrows) {
    const Vec3 length(arrow.to[0] - arrow.from[0], arrow.to[1] - arrow.from[1], arrow.to[2] - arrow.from[2]);
    longest = std::max(longest, length.norm());
  }
  const double height = extent.high.z() - extent.low.z();
  EXPECT_LE(longest, 1.001 * height);
  EXPECT_GT(longest, 0.39 * height);  // of a step from 2 to 5
}

// One bar falls across another, 0.3 m from their ends: on each of them stands the force that the solver has.
TEST(MemberArrows, between_two_members_are_equal_and_opposite_and_those_of_the_solver) {
  const io::Scene scene = io::parse_scene(R"(topple = 1
title = "bars"
[run]
duration = "1 s"
settle = false
[contact]
alpha = "50 kgf"
)" + k_library + R"(
[[frame]]
name = "below"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel", elements = 2, up = [0, 0, 1] }]
supports = [{ node = 0, fix = "xyzXYZ" }, { node = 1, fix = "xyzXYZ" }]
[[frame]]
name = "above"
nodes = [[0.3, -0.3, 0.031], [0.3, 0.7, 0.031]]
members = [{ nodes = [0, 1], section = "post", material = "steel", elements = 2, up = [0, 0, 1] }]
)",
                                          "bars.toml");
  topple::Run run(scene.setup);
  while (run.time() < 0.3 && run.member_contacts().empty()) ASSERT_TRUE(run.advance().ok());
  ASSERT_EQ(run.member_contacts().size(), 1u);
  const MemberForce& touch = run.member_contacts()[0];
  const io::FrameRow row = io::frame_row(run);
  RunExtent extent;
  extent.add(scene.setup, scene.setup.parameters, row);
  const render::SceneFrame frame =
      Bridge(scene, extent).frame(row, scene.setup.parameters, {.contact_forces = true});
  ASSERT_EQ(frame.arrows.size(), 2u);
  const double newtons = newtons_per_decimetre(extent) / 0.1;
  for (int k = 0; k < 3; ++k)
    for (const int on : {0, 1}) {
      const render::Arrow& arrow = frame.arrows[on];
      const double force = (on == 0 ? 1 : -1) * touch.force[k];
      EXPECT_NEAR((arrow.to[k] - arrow.from[k]) * newtons, force, 1e-4 * touch.force.norm());  // of floats
    }
  EXPECT_GT(frame.arrows[1].to[2], frame.arrows[1].from[2]);  // the upper one is pushed up
  for (const render::Arrow& arrow : frame.arrows) {
    EXPECT_NEAR(arrow.from[0], 0.3, 1e-3);
    EXPECT_NEAR(arrow.from[1], 0, 1e-3);
  }
  EXPECT_NEAR(frame.arrows[1].from[2] - frame.arrows[0].from[2], 0.03 * (1 - touch.depth), 1e-4);
}

TEST_F(BridgeTest, panels_are_left_out_when_they_are_switched_off) {
  const Bridge bridge(scene_, extent_);
  EXPECT_EQ(bridge.frame(end_, scene_.setup.parameters).panels.size(), model().panels.size());
  EXPECT_TRUE(bridge.frame(end_, scene_.setup.parameters, {.panels = false}).panels.empty());
}

TEST_F(BridgeTest, trails_lead_to_the_centre_of_gravity_and_grow_stronger) {
  RunExtent extent;
  std::vector<io::FrameRow> rows;
  for (int i = 0; i <= 30; ++i) {
    rows.push_back(start_);
    rows.back().time = 0.1 * i;
    rows.back().body[0].x = 0.01 * i;
    extent.add(scene_.setup, scene_.setup.parameters, rows.back());
  }
  const Bridge bridge(scene_, extent);
  for (const Trails trails : {Trails::second, Trails::run}) {
    const render::SceneFrame frame = bridge.frame(rows[20], scene_.setup.parameters, {.trails = trails});
    ASSERT_EQ(frame.trails.size(), 2u);
    const render::Trail& centre = frame.trails[0];
    EXPECT_EQ(centre.points.size(), trails == Trails::second ? 11u : 21u);
    EXPECT_LT(distance(centre.points.back(), rows[20].body[0].centre() + Vec3(start_.floor_displacement)),
              1e-6);
    EXPECT_TRUE(std::ranges::is_sorted(centre.strength));
    EXPECT_EQ(centre.strength.back(), 1);
    EXPECT_GT(frame.trails[1].points[0][2], centre.points[0][2] + 0.5f);  // the top
  }
}

// Also where furniture is drawn as it looks.
TEST(Bridge, doors_are_drawn_and_people_under_a_piece_are_told) {
  const io::Scene scene = io::parse_scene(R"(topple = 1
[run]
want = ["motion"]
[floor]
[[wall]]
name = "back"
at = [-2, 0]
normal = [1, 0, 0]
[[door]]
name = "door"
wall = "back"
at = 0
width = 0.9
[[place]]
name = "seat"
at = [1, 0]
[[block]]
name = "box"
size = [0.5, 0.5, 0.5]
mass = 20
at = [1, 1, 0]
)",
                                          "room.toml");
  const topple::Setup& setup = scene.setup;
  io::FrameRow row = io::frame_row(topple::Run(setup));
  RunExtent extent;
  extent.add(setup, setup.parameters, row);
  for (std::size_t n = 0; 3 * n < row.position.size(); ++n) row.position[3 * n + 1] -= 1;
  row.time = 1;
  extent.add(setup, setup.parameters, row);
  const Bridge bridge(scene, extent);
  render::SceneFrame frame = bridge.frame(row, setup.parameters);
  const std::vector<std::string>& lines = frame.caption.lines;
  for (const char* told : {"seat: cannot leave, blocked where they are by box", "seat: hit by box at 1.0 s"})
    EXPECT_NE(std::ranges::find(lines, told), lines.end()) << told;
  EXPECT_GE(frame.caption.most_lines, static_cast<int>(lines.size()));
  for (const std::string& line : Bridge(scene, extent, false).frame(row, setup.parameters).caption.lines)
    EXPECT_EQ(line.find("seat"), std::string::npos);
  const auto is_door = [](const render::Panel& panel) { return panel.body == render::k_no_body; };
  EXPECT_EQ(std::ranges::count_if(frame.panels, is_door), 1);
  SolidBodies(scene, Bodies::solid).dress(row, frame);
  EXPECT_EQ(std::ranges::count_if(frame.panels, is_door), 1);
}

}  // namespace
}  // namespace topple::app
