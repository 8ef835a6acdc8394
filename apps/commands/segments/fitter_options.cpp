// SPDX-License-Identifier: BSD-3-Clause
#include "commands/segments/fitter_options.h"

#include <map>

#include "common/command.h"

namespace gaussmap::app {
namespace {

const std::string kGroup = "Fitting";
const std::map<std::string, EvidencePolicy> kPolicies = {{"moments", EvidencePolicy::MomentCells},
                                                         {"particles", EvidencePolicy::ParticleSets}};
const std::map<std::string, SegmentAssociation> kAssociations = {{"surface", SegmentAssociation::Surface},
                                                                 {"polygon", SegmentAssociation::Polygon}};
const std::map<std::string, MergeCandidates> kCandidates = {{"near", MergeCandidates::Near},
                                                            {"linked", MergeCandidates::Linked}};
const std::map<std::string, bool> kHoles = {{"split", true}, {"keep", false}};
const std::map<std::string, bool> kEnds = {{"adjusted", true}, {"fitted", false}};
const std::map<std::string, ParticleLimit> kLimits = {{"bins", ParticleLimit::Bins},
                                                      {"segment", ParticleLimit::Segment}};

bool isDependent(const FitterInput& input) {
  return input.utility == "viewpoint-dependent";
}
bool isPapers(const FitterInput& input) {
  return isDependent(input) || input.utility == "viewpoint-invariant";
}

void refuse(bool given, const std::string& option, const std::string& reason) {
  if (given) throw UsageError(option + ": " + reason);
}

ViewpointInvariantOptions invariantOptions(const FitterInput& input) {
  ViewpointInvariantOptions options;
  options.min_length = input.min_length.value_or(options.min_length);
  options.sigma_threshold = input.sigma.value_or(options.sigma_threshold);
  options.merge_ratio = input.merge_ratio.value_or(options.merge_ratio);
  return options;
}

ViewpointDependentOptions dependentOptions(const FitterInput& input) {
  ViewpointDependentOptions options;
  options.far = invariantOptions(input);
  options.scale = input.view_scale.value_or(options.scale);
  options.radius = input.view_radius.value_or(options.radius);
  if (!input.viewpoint.empty()) {
    if (!(input.viewpoint[2] > 0.0)) throw UsageError("--viewpoint: the radius must be above 0");
    options.viewpoint = {input.viewpoint[0], input.viewpoint[1]};
    options.radius = input.viewpoint[2];
    options.fixed = true;
  }
  return options;
}

}  // namespace

void addFitterOptions(Command& command, FitterInput& input) {
  SegmentFitterOptions& options = input.options;
  const auto as_in_paper = [&input] {
    input.options = SegmentFitterOptions::leal2000();
    input.utility = "viewpoint-invariant";
    input.no_prune = input.no_refine = input.as_in_paper = true;
  };
  for (const Option& option : {
           command.preset("--as-in-paper", as_in_paper,
                          "use the settings of Leal et al. 2000; options that are also given override them"),
           command.choice("--utility", input.utility,
                          {"description-length", "viewpoint-invariant", "viewpoint-dependent"},
                          "criterion for splitting and merging segments"),
           command.choiceOf("--policy", options.policy, kPolicies,
                            "evidence that a segment keeps: moments in cells, or particles"),
           command.number(
               "--l-min", input.min_length, 1e-3, 1e6,
               "utilities of the paper: shorter segments are not split [m]; also bounds particles; default: 1"),
           command.number("--sigma", input.sigma, 1e-6, 1e6,
                          R"(standard deviation across a segment [m]: expected (description-length, default: 0.03)
                          or maximum (utilities of the paper, default: 0.06))"),
           command.number("--segment-cost", input.segment_cost, 0.0, 1e9,
                          "description-length: cost per segment [nat]; default: 3"),
           command.number("--merge-ratio", input.merge_ratio, 0.0, 0.999999,
                          "utilities of the paper: alpha, merge up to this share of sigma^2; default: 0.5"),
           command.numbers("--viewpoint", input.viewpoint, 3, -1e9, 1e9,
                           "viewpoint-dependent: x y r, more detail within the distance r of (x, y) [m]"),
           command.number("--view-radius", input.view_radius, 1e-3, 1e9,
                          "viewpoint-dependent: more detail this near to the sensor [m]; default: 5"),
           command.number("--view-scale", input.view_scale, 1e-3, 1.0,
                          "viewpoint-dependent: factor of --l-min in that area; default: 0.33"),
           command.text(
               "--observer-path", input.observer_path,
               "viewpoint-dependent: after the scans, an observer walks along these positions (file with x y per line, "
               "or poses); the map has more detail near it"),
           command.number("--range-noise", options.noise.range, 0.0, 100.0,
                          "standard deviation of the laser's ranges [m]"),
           command.number("--bearing-noise", options.noise.bearing, 0.0, 1.0,
                          "standard deviation of the laser's bearings [rad]"),
           command.number("--particles", options.particles.samples, 1, 100000, "particles per observation"),
           command.number("--per-metre", options.particles.per_metre, 1e-3, 1e9,
                          "maximum number of particles per metre of segment"),
           command.choiceOf("--particle-limit", options.particles.limit, kLimits,
                            R"(where surplus particles are removed: in bins of 0.25 m with too many (bins),
                            or anywhere in the segment, as in the paper (segment))"),
           command.choiceOf(
               "--association", options.association, kAssociations,
               "which segment gets an observation: the nearest one with a fitting surface (surface), or "
               "the nearest one whose polygon contains the mean of the samples, as in the paper (polygon)"),
           command.choiceOf("--merge-candidates", options.merge_candidates, kCandidates,
                            "which segments can be merged: near ones (near), or only neighbours in a chain, as in the "
                            "paper (linked)"),
           command.choiceOf("--holes", options.split_holes, kHoles,
                            "segments without evidence for more than 0.5 m: split them there (split), or not, as in "
                            "the paper (keep)"),
           command.choiceOf("--ends", options.adjust_ends, kEnds,
                            "ends of segments: adjusted to nearby walls (adjusted), or those of the evidence, as in "
                            "the paper (fitted)"),
           command.flag("--no-prune", input.no_prune, "keep segments that many rays pass through"),
           command.flag("--no-refine", input.no_refine,
                        "do not optimise the whole map at the end; the utilities of the paper never do"),
           command.seed(options.particles.seed, "seed of the particles"),
       })
    option.group(kGroup);
  command.files({"--observer-path"});
}

std::string givenFitterOption(const Command& command) {
  return command.givenOf(kGroup);
}

SegmentFitterOptions fitterOptions(const FitterInput& input) {
  SegmentFitterOptions options = input.options;
  const bool particles = options.policy == EvidencePolicy::ParticleSets;
  refuse(input.min_length && !isPapers(input) && !particles, "--l-min",
         "only for the paper's utilities and for particles; add --utility viewpoint-invariant or --policy particles");
  options.min_length = input.min_length.value_or(options.min_length);
  options.prune = !input.no_prune;
  options.optimise = !input.no_refine && !isPapers(input);  // the decisions of the paper's utilities are final
  return options;
}

std::shared_ptr<SegmentUtility> makeUtility(const FitterInput& input) {
  refuse(!input.viewpoint.empty() && !isDependent(input), "--viewpoint", "add --utility viewpoint-dependent");
  refuse(!input.observer_path.empty() && !isDependent(input), "--observer-path", "add --utility viewpoint-dependent");
  refuse(!input.observer_path.empty() && !input.viewpoint.empty(), "--observer-path",
         "not with --viewpoint, because that observer does not move");
  refuse(input.view_radius && !isDependent(input), "--view-radius", "add --utility viewpoint-dependent");
  refuse(input.view_scale && !isDependent(input), "--view-scale", "add --utility viewpoint-dependent");
  refuse(input.view_radius && !input.viewpoint.empty(), "--view-radius", "not with --viewpoint, which has a radius");
  refuse(input.merge_ratio && !isPapers(input), "--merge-ratio", "add --utility viewpoint-invariant");
  refuse(input.segment_cost && isPapers(input), "--segment-cost", "only for --utility description-length");
  if (isDependent(input)) return std::make_shared<ViewpointDependentUtility>(dependentOptions(input));
  if (isPapers(input)) return std::make_shared<ViewpointInvariantUtility>(invariantOptions(input));
  DescriptionLengthOptions options;
  options.sigma = input.sigma.value_or(options.sigma);
  options.segment_cost = input.segment_cost.value_or(options.segment_cost);
  return std::make_shared<DescriptionLengthUtility>(options);
}

}  // namespace gaussmap::app
