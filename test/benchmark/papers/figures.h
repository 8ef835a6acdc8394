// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "papers/leal.h"
#include "papers/report.h"
#include "papers/sequences.h"

namespace gaussmap::papers {

/// Adds the list of the figures of both papers: where each is on the page, or the command that makes it.
void reportFigures(Report& report);

/// Adds a picture like Fig. 7 of Yguel 2009: the coarsest and the finest scale of a planar map as printed, the coarse
/// cells in black, ellipses of 3 sigma.
void drawFigure7(const Sequence<2>& sequence, Report& report);

/// Adds pictures like Figs. 4 and 5 of Leal 2000: the segments and the particles, with eq. (4) and with eq. (5).
void drawExamples(const LealResults& results, Report& report);

}  // namespace gaussmap::papers
