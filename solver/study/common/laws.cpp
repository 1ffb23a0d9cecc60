#include "solver/study/common/laws.h"

namespace topple::study {

std::string law_name(ContactLawKind kind) {
  switch (kind) {
    case ContactLawKind::coulomb:
      return "coulomb";
    case ContactLawKind::paper:
      return "paper";
    case ContactLawKind::printed:
      break;
  }
  return "printed";
}

}  // namespace topple::study
