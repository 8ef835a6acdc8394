// SPDX-License-Identifier: BSD-3-Clause
#include "commands/segments/fitter_options.h"

#include <map>

#include "common/options.h"

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

void addFitterOptions(CLI::App& command, FitterInput& input) {
  SegmentFitterOptions& options = input.options;
  const auto own = [](CLI::Option* option) { return option->group(kGroup); };
  own(command.add_option("--utility", input.utility, "what decides about split and merge"))
      ->check(CLI::IsMember({"description-length", "viewpoint-invariant", "viewpoint-dependent"}))
      ->capture_default_str();
  own(command.add_option("--policy", options.policy, "what a segment remembers: moments in cells, or particles"))
      ->transform(CLI::CheckedTransformer(kPolicies, CLI::ignore_case))
      ->default_str("moments");
  own(command.add_option("--l-min", input.min_length,
                         "shortest segment that the utilities of the paper split, bound of particles [m]; default: 1"))
      ->check(numberBetween(1e-3, 1e6));
  own(command.add_option("--sigma", input.sigma,
                         "standard deviation across a segment: expected (description-length, default 0.03) or allowed "
                         "(utilities of the paper, default 0.06) [m]"))
      ->check(numberBetween(1e-6, 1e6));
  own(command.add_option("--segment-cost", input.segment_cost,
                         "cost of a segment for description-length [nat]; default: 3"))
      ->check(numberBetween(0.0, 1e9));
  own(command.add_option(
          "--merge-ratio", input.merge_ratio,
          "alpha: the utilities of the paper merge below this part of the allowed variance; default: 0.5"))
      ->check(numberBetween(0.0, 0.999999));
  own(command.add_option("--viewpoint", input.viewpoint,
                         "x y r: more detail within the distance r of (x, y) [m]; for --utility viewpoint-dependent"))
      ->expected(3)
      ->check(numberBetween(-1e9, 1e9));
  own(command.add_option(
          "--view-radius", input.view_radius,
          "more detail within this distance of the sensor [m]; for --utility viewpoint-dependent; default: 5"))
      ->check(numberBetween(1e-3, 1e9));
  own(command.add_option("--view-scale", input.view_scale, "--l-min in that area, as a part of --l-min; default: 0.33"))
      ->check(numberBetween(1e-3, 1.0));
  own(command.add_option("--range-noise", options.noise.range, "standard deviation of the laser's ranges [m]"))
      ->check(numberBetween(0.0, 100.0))
      ->capture_default_str();
  own(command.add_option("--bearing-noise", options.noise.bearing, "standard deviation of its bearings [rad]"))
      ->check(numberBetween(0.0, 1.0))
      ->capture_default_str();
  own(command.add_option("--particles", options.particles.samples, "particles per observation"))
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  own(command.add_option("--per-metre", options.particles.per_metre, "particles kept per metre of segment"))
      ->check(numberBetween(1e-3, 1e9))
      ->capture_default_str();
  own(command.add_option(
          "--particle-limit", options.particles.limit,
          "where surplus particles are dropped: in the stretch that has too many, or in the segment (paper)"))
      ->transform(CLI::CheckedTransformer(kLimits, CLI::ignore_case))
      ->default_str("bins");
  own(command.add_flag("--no-prune", input.no_prune, "keep segments that many rays pass through"));
  own(command.add_flag(
      "--no-refine", input.no_refine,
      "do not refine the map as a whole after the last scan; always so with the utilities of the paper"));
  own(addSeed(command, options.particles.seed, "seed of the particles"));
}

std::string givenFitterOption(const CLI::App& command) {
  for (const CLI::Option* option :
       command.get_options([](const CLI::Option* o) { return o->get_group() == kGroup && o->count() > 0; }))
    return option->get_name();
  return "";
}

SegmentFitterOptions fitterOptions(const FitterInput& input) {
  SegmentFitterOptions options = input.options;
  const bool particles = options.policy == EvidencePolicy::ParticleSets;
  refuse(input.min_length && !isPapers(input) && !particles, "--l-min",
         "only the paper's utilities and particles have one: add --utility viewpoint-invariant or --policy particles");
  options.min_length = input.min_length.value_or(options.min_length);
  options.prune = !input.no_prune;
  options.refine = !input.no_refine && !isPapers(input);  // what they decided stays
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
