// Kinds of furniture, and a piece on its way from [[furniture]] to the body that it becomes.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_entry.h"
#include "solver/math/types.h"

namespace topple::io {

/// Contact width of a section by its name, m; 0: there is no such section.
using SectionWidth = std::function<double(const std::string& section)>;

/// Of [[section]] entries, else of stock (stock.h).
SectionWidth section_widths(std::vector<Node> sections, const std::string& origin);

/// Outer depth, width and height of a body that stands upright, m. `body`: an entry of `table`.
Vec3 outer_size(const std::string& table, const Entry& body, const SectionWidth& width);

/// A kind as its file has it.
struct FurnitureKind {
  std::string name;   ///< "bookshelf": of the file without folder and extension
  std::string title;  ///< of the file
  std::string source;
  std::string table;                      ///< of the body: "cabinet", "frame" or "block"
  Node body;                              ///< without name
  std::vector<Node> materials, sections;  ///< of the file, named "bookshelf/post"; the body calls them so
  Vec3 size;                              ///< m, outer depth, width and height
  double mass;                            ///< kg, empty
  double contents_mass;                   ///< kg
  Vec3 contents_cg;                       ///< m, from the middle of the outer base
};

/// Where a piece stands.
struct Stand {
  Vec3 at;     ///< m, middle of the footprint
  Vec3 front;  ///< unit, horizontal: where its front looks
  double yaw;  ///< rad, of the front
};

/// A piece whose body has yet to be fitted to it.
struct Piece {
  Entry entry;  ///< [[furniture]]
  FurnitureKind kind;
  std::string name = {};
  Node body = {};                   ///< of kind.table
  Vec3 size = Vec3::Zero();         ///< m, outer
  double mass = 0;                  ///< kg, empty
  double contents_mass = 0;         ///< kg
  Vec3 contents_cg = Vec3::Zero();  ///< m, from the middle of the outer base
  SectionWidth width = {};
  Stand stand = {};  ///< after place_pieces()

  /// Its body, for what is read of it.
  Entry body_entry() const { return entry.as(kind.table, body); }
};

/// Refuses contents whose centre is not within a piece of this outer size.
void check_inside(const Entry& contents, const Vec3& cg, const Vec3& size);

/// Gives the body the size, the mass and the centre of gravity of the piece and its contents. Throws
/// InputError.
void fit(Piece& piece);

/// Size of a piece between the centre lines of its edges, m.
Vec3 rocking_size(const Piece& piece);

/// Puts the fitted body there.
void put(Piece& piece, const Stand& stand);

/// Puts each fitted body where its piece stands: `at`, `against` a [[wall]] of `root`, or `beside` another of
/// the pieces. Throws InputError.
void place_pieces(std::vector<Piece>& pieces, const Entry& root);

}  // namespace topple::io
