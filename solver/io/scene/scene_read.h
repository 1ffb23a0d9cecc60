// From a checked scene to a Setup, part by part. All throw InputError.
#pragma once

#include "solver/io/scene/scene_content.h"
#include "solver/io/scene/scene_entry.h"
#include "solver/io/scene/scene_words.h"
#include "solver/run/run.h"

namespace topple::io {

/// [run]: settings, gravity, integrator.
void read_run(const Entry& root, Setup& setup);

/// [[shake]]; the files that they name become part of the scene.
void read_shakes(const Entry& root, const ReadSceneFile& read, Scene& scene);

/// [contact].
void read_contact(const Entry& root, Setup& setup);

/// A [floor] or [[wall]] made of members.
bool is_beams(const Entry& entry);

/// Planes: [floor] first, then each [[wall]].
void read_planes(const Entry& root, Setup& setup);

/// [[section]], not completed.
Section read_section(const Entry& entry);

/// [[material]] and [[section]]; sections are completed with the Poisson's ratio of the first member that
/// uses them.
void read_materials_and_sections(const Entry& root, Setup& setup);

/// [[cabinet]] in the order of the file, then [[frame]], then [[block]], then floors and walls of members.
/// The entry of each body that is furniture.
std::vector<Entry> read_bodies(const Entry& root, Setup& setup);
/// Contact would throw out what starts within a floor or a wall. `entries`: those of read_bodies.
void check_planes(const std::vector<Entry>& entries, const Setup& setup);
/// Bodies that start within each other cannot be told apart by contact.
void check_overlap(const std::vector<Entry>& entries, const Setup& setup);

/// Refuses `model = "planar"` and `restitution` of a body that does not begin as a planar block, and a
/// restitution by which it would gain energy; after bodies, shakes and anchors.
void check_planar(const Entry& root, const Setup& setup);

/// contact.alpha where it is left out; after the bodies.
void choose_alpha(const Entry& root, Setup& setup);

/// Index of the body that the entry's key `body` names.
int find_body(const Entry& entry, const Model& model);
/// Likewise of another key.
int find_body(const Entry& entry, const char* key, const Model& model);

/// [[anchor]]; after the bodies.
void read_anchors(const Entry& root, Setup& setup);

/// [[fixing]]; after the anchors.
void read_fixings(const Entry& root, Setup& setup);

/// [[probe]]; after the bodies.
void read_probes(const Entry& root, Setup& setup);

/// [[door]] and [[place]]; after the bodies.
void read_room(const Entry& root, Setup& setup);

/// run.control; after the bodies.
void read_control(const Entry& root, Setup& setup);

/// [[expect]].
void read_expectations(const Entry& root, Scene& scene);

}  // namespace topple::io
