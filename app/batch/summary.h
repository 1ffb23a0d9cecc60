// What a run came to: for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"
#include "solver/study/common/refinement.h"

namespace topple::app {

/// Natural frequencies and shapes of each body, `count` of them: the summary of analysis = "modes".
nlohmann::ordered_json modes_summary(const io::Scene& scene, int count);

/// The summary of interface 3. What does not exist is null; numbers that are not finite are null too.
/// `status`: completed, stopped, diverged or interrupted.
nlohmann::ordered_json summary(const io::Scene& scene, Run& run, const std::string& status, double wall_s);

/// "error_estimate" of interface 3, from `run` at the setup's steps and `finer` at those of study::refined.
/// The numbers at the top are the greatest of all bodies; null where the two part in the verdict on one,
/// which `disagreements` then says in words.
nlohmann::ordered_json error_estimate(const Setup& setup, const Outcome& run, const Outcome& finer);

/// The same when the finer run failed.
nlohmann::ordered_json failed_estimate(const Setup& setup, const std::string& message);

/// "step and its parts halved" or "tolerance divided by 100, parts of a step by 4": what the finer run of
/// `setup` has.
std::string refinement_in_words(const Setup& setup);

/// Name, body, type and strength of an anchor; where its ends are; of a [[fixing]] its kind too.
nlohmann::ordered_json describe_anchor(const Model& model, const Anchor& anchor);
/// Of one that stands for a [[fixing]], which nodes it took and how far they are, in a line.
std::string fixing_line(const nlohmann::ordered_json& described);

/// Name and body of a stopper, the nodes that it lifts and by how much; then in a line.
nlohmann::ordered_json describe_wedge(const Model& model, const Wedge& wedge);
std::string wedge_line(const nlohmann::ordered_json& described);

/// Of a UTF-8 text; what is not counts as one each.
std::size_t letters(const std::string& text);

/// Three numbers; null where one is not finite.
nlohmann::ordered_json vector_json(const Vec3& v);

/// JSON text in one line, or indented. What is not UTF-8 (a file's name can be anything) becomes U+FFFD.
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);

/// The summary as a table of a few lines, without its warnings.
std::string summary_table(const nlohmann::ordered_json& summary);

/// The line about `energy`, named as in the summary.
std::string energy_in_words(const nlohmann::ordered_json& energy);

}  // namespace topple::app
