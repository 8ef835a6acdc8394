// SPDX-License-Identifier: BSD-3-Clause
#include "commands/segments/fitter_options.h"

#include <map>

#include "common/command.h"

namespace gaussmap::app {
namespace {

const std::string kGroup = "Fitting";
const std::map<std::string, EvidencePolicy> kPolicies = {{"moments", EvidencePolicy::MomentCells},
                                                         {"particles", EvidencePolicy::ParticleSets}};
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
  for (const Option& option : {
           command.choice("--utility", input.utility,
                          {"description-length", "viewpoint-invariant", "viewpoint-dependent"},
                          "what decides about split and merge"),
           command.choiceOf("--policy", options.policy, kPolicies,
                            "what a segment remembers: moments in cells, or particles"),
           command.number("--l-min", input.min_length, 1e-3, 1e6,
                          "shortest segment that the utilities of the paper split, bound of particles [m]; default: 1"),
           command.number("--sigma", input.sigma, 1e-6, 1e6,
                          "standard deviation across a segment: expected (description-length, default 0.03) or allowed "
                          "(utilities of the paper, default 0.06) [m]"),
           command.number("--segment-cost", input.segment_cost, 0.0, 1e9,
                          "cost of a segment for description-length [nat]; default: 3"),
           command.number(
               "--merge-ratio", input.merge_ratio, 0.0, 0.999999,
               "alpha: the utilities of the paper merge below this part of the allowed variance; default: 0.5"),
           command.numbers("--viewpoint", input.viewpoint, 3, -1e9, 1e9,
                           "x y r: more detail within the distance r of (x, y) [m]; for --utility viewpoint-dependent"),
           command.number(
               "--view-radius", input.view_radius, 1e-3, 1e9,
               "more detail within this distance of the sensor [m]; for --utility viewpoint-dependent; default: 5"),
           command.number("--view-scale", input.view_scale, 1e-3, 1.0,
                          "--l-min in that area, as a part of --l-min; default: 0.33"),
           command.number("--range-noise", options.noise.range, 0.0, 100.0,
                          "standard deviation of the laser's ranges [m]"),
           command.number("--bearing-noise", options.noise.bearing, 0.0, 1.0,
                          "standard deviation of its bearings [rad]"),
           command.number("--particles", options.particles.samples, 1, 100000, "particles per observation"),
           command.number("--per-metre", options.particles.per_metre, 1e-3, 1e9, "particles kept per metre of segment"),
           command.choiceOf("--particle-limit", options.particles.limit, kLimits,
                            "where surplus particles are dropped: in the stretch that has too many (bins), or in the "
                            "segment (paper)"),
           command.flag("--no-prune", input.no_prune, "keep segments that many rays pass through"),
           command.flag("--no-refine", input.no_refine,
                        "do not refine the map as a whole after the last scan; always so with the utilities of the "
                        "paper"),
           command.seed(options.particles.seed, "seed of the particles"),
       })
    option.group(kGroup);
}

std::string givenFitterOption(const Command& command) {
  return command.givenOf(kGroup);
}

SegmentFitterOptions fitterOptions(const FitterInput& input) {
  SegmentFitterOptions options = input.options;
  const bool particles = options.policy == EvidencePolicy::ParticleSets;
  refuse(input.min_length && !isPapers(input) && !particles, "--l-min",
         "only the paper's utilities and particles have one: add --utility viewpoint-invariant or --policy particles");
  options.min_length = input.min_length.value_or(options.min_length);
  options.prune = !input.no_prune;
  options.optimise = !input.no_refine && !isPapers(input);  // what they decided stays
  return options;
}

std::shared_ptr<SegmentUtility> makeUtility(const FitterInput& input) {
  refuse(!input.viewpoint.empty() && !isDependent(input), "--viewpoint", "add --utility viewpoint-dependent");
  refuse(input.view_radius && !isDependent(input), "--view-radius", "add --utility viewpoint-dependent");
  refuse(input.view_scale && !isDependent(input), "--view-scale", "add --utility viewpoint-dependent");
  refuse(input.view_radius && !input.viewpoint.empty(), "--view-radius", "--viewpoint has a radius of its own");
  refuse(input.merge_ratio && !isPapers(input), "--merge-ratio", "add --utility viewpoint-invariant");
  refuse(input.segment_cost && isPapers(input), "--segment-cost", "of --utility description-length only");
  if (isDependent(input)) return std::make_shared<ViewpointDependentUtility>(dependentOptions(input));
  if (isPapers(input)) return std::make_shared<ViewpointInvariantUtility>(invariantOptions(input));
  DescriptionLengthOptions options;
  options.sigma = input.sigma.value_or(options.sigma);
  options.segment_cost = input.segment_cost.value_or(options.segment_cost);
  return std::make_shared<DescriptionLengthUtility>(options);
}

}  // namespace gaussmap::app
