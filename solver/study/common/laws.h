// Contact laws as studies go through them and call them.
#pragma once

#include <string>

#include "solver/model/parameters.h"

namespace topple::study {

inline constexpr ContactLawKind k_laws[] = {ContactLawKind::coulomb, ContactLawKind::paper,
                                            ContactLawKind::printed};

/// A law as scenes call it: "coulomb".
std::string law_name(ContactLawKind kind);

}  // namespace topple::study
