// `topple study`: one command a study.
#pragma once

#include "app/study/study_options.h"

namespace topple::app {

/// `topple study elements`: the element comparison.
int elements_command(const StudyOptions& options);
/// `topple study penalty`: penalty contact of a scene.
int penalty_command(const StudyOptions& options);
/// `topple study overturn`: who overturns over two keys.
int overturn_command(const StudyOptions& options);
/// `topple study precision`: error against cost of integrators, steps and models.
int precision_command(const StudyOptions& options);
/// `topple study stability`: where time integration fails over two keys.
int stability_command(const StudyOptions& options);

}  // namespace topple::app
