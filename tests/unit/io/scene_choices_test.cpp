// Keys that need another analysis, law, integrator or type than the scene has.
#include <gtest/gtest.h>

#include "scene_samples.h"

namespace topple::io {
namespace {

TEST(SceneChoices, rigid_and_elastic_bodies_do_not_take_an_integrator_of_frames) {
  EXPECT_EQ(error_of(k_cabinet_scene, {"cabinet.free.model=rigid", "run.integrator=newmark"}),
            "--set cabinet.free.model=rigid: cabinet.free.model: \"rigid\" bodies take central differences: "
            "run.integrator = \"newmark\" is for frames");
  EXPECT_EQ(error_of(k_cabinet_scene, {"cabinet.free.model=elastic", "run.integrator=central-difference"}),
            "no error");
}

TEST(SceneChoices, keys_of_another_analysis_are_refused) {
  const std::string but = ": belongs to analysis = dynamic, but analysis is static";
  for (const char* line :
       {"duration = 1", "integrator = \"newmark\"", "beta = 0.25", "gamma = 0.5", "spectral_radius = 0.5",
        "time_step = 1e-3", "tolerance = 1e-3", "output_rate = 10", "stop_when = \"never\""}) {
    const std::string key(line, std::string(line).find(' '));
    EXPECT_EQ(after_beam("[run]\nanalysis = \"static\"\n" + std::string(line) + "\n"),
              "s.toml:19:1: run." + key + but);
    EXPECT_EQ(after_beam("[run]\n" + std::string(line) + "\nanalysis = \"modes\"\n"),
              "s.toml:18:1: run." + key + ": belongs to analysis = dynamic, but analysis is modes");
  }
  for (const char* line :
       {"law = \"coulomb\"", "restitution = 0.5", "normal_speed = 0.1", "slip_speed = 0.1"}) {
    const std::string key(line, std::string(line).find(' '));
    EXPECT_EQ(after_beam("[contact]\n" + std::string(line) + "\n[run]\nanalysis = \"static\"\n"),
              "s.toml:18:1: contact." + key + but);
  }
  EXPECT_EQ(after_beam("[run]\nanalysis = \"static\"\n[[shake]]\nfrequency = 1\namplitude = 1\n"),
            "s.toml:19:3: shake" + but);
  for (const char* key : {"velocity", "angular_velocity"}) {
    const std::string line = std::string(key) + " = [1, 0, 0]\n";
    EXPECT_EQ(in_cabinet(line + "[run]\nanalysis = \"static\"\nsettle = false\n"),
              "s.toml:16:1: cabinet.free." + std::string(key) + but);
    EXPECT_EQ(error_of(replaced(k_scene, "supports", line + "supports") +
                       "[run]\nanalysis = \"static\"\nsettle = false\n"),
              "s.toml:16:1: frame.beam." + std::string(key) + but);
  }
  EXPECT_EQ(after_beam("[run]\nanalysis = \"static\"\nload_steps = 3\nsettle = false\ngravity = [0, 0, -1]\n"
                       "elements = \"asi\"\nwant = [\"stress\"]\n[contact]\nalpha = \"90 kgf\"\nq = 1\n"
                       "friction = 0.5\n"),
            "no error");
  EXPECT_EQ(error_of(k_scene, {"run.analysis=static", "run.duration=1"}),
            "--set run.duration=1: run.duration" + but);
  EXPECT_EQ(
      after_beam("[contact]\nrestitution = 0.5\n[run]\nanalysis = \"statik\"\n"),
      "s.toml:20:12: run.analysis: \"statik\" is not one of dynamic, static, modes; the nearest is static");
}

TEST(SceneChoices, keys_of_a_choice_not_made_are_refused) {
  EXPECT_EQ(after_beam("[contact]\nlaw = \"paper\"\nrestitution = 0.5\n"),
            "s.toml:19:1: contact.restitution: belongs to law = coulomb, but law is paper");
  EXPECT_EQ(after_beam("[contact]\nslip_speed = 0.5\n"),
            "s.toml:18:14: contact.slip_speed: belongs to law = paper or printed, or to a friction_static");
  EXPECT_EQ(after_beam("[run]\nspectral_radius = 0.5\nintegrator = \"central-difference\"\n"),
            "s.toml:18:1: run.spectral_radius: belongs to integrator = auto or generalized-alpha, but "
            "integrator is "
            "central-difference");
  EXPECT_EQ(after_beam("[run]\nspectral_radius = 0.5\n"), "no error");
  EXPECT_EQ(after_beam("[run]\nbeta = 0.25\n"),
            "s.toml:18:1: run.beta: belongs to integrator = newmark, but integrator is auto");
  EXPECT_EQ(after_beam("[run]\ngamma = 0.5\nintegrator = \"newmark\"\n"), "no error");
  EXPECT_EQ(after_beam("[run]\nload_steps = 3\n"),
            "s.toml:18:1: run.load_steps: belongs to analysis = static, but analysis is dynamic");
  EXPECT_EQ(after_beam("[run]\ncontrol = { node = 1, dof = \"x\" }\n"),
            "s.toml:18:1: run.control: belongs to analysis = static, but analysis is dynamic");
  EXPECT_EQ(after_beam("[run]\ntolerance = 1e-3\n"), "no error");
  EXPECT_EQ(after_beam("[run]\ntolerance = 1e-3\ntime_step = 2e-3\n"),
            "s.toml:18:13: run.tolerance: belongs to time_step = auto, but time_step is fixed");
  EXPECT_EQ(after_beam("[run]\ntolerance = 1e-3\ntime_step = \"2 ms\"\n"),
            "s.toml:18:13: run.tolerance: belongs to time_step = auto, but time_step is fixed");
  EXPECT_EQ(after_beam("[[shake]]\nfrequency = 1\namplitude = 1\nduration = 1\n"),
            "s.toml:20:1: shake.1.duration: belongs to type = sweep or pulse, but type is sine");
  EXPECT_EQ(in_cabinet("bracing = \"none\"\npanel_thickness = 1e-3\n"),
            "s.toml:17:1: cabinet.free.panel_thickness: belongs to bracing = panels, but bracing is none");
  EXPECT_EQ(error_of(replaced(k_scene, "\"box\"", "\"solid\"")),
            "s.toml:11:1: section.post.thickness: belongs to shape = box or pipe, but shape is solid");
}

}  // namespace
}  // namespace topple::io
