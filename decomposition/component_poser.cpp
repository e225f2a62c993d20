// SPDX-License-Identifier: Apache-2.0
#include "sac/component_poser.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <utility>

#include "decomposition/component_model.h"

namespace sac {
namespace {

Status CheckFinite(std::span<const float> weights) {
  if (std::all_of(weights.begin(), weights.end(), [](float w) { return std::isfinite(w); })) return Status::Ok();
  return Status::InvalidArgument("a weight is not finite");
}

Status CheckPose(const RigidPose& pose) {
  const auto finite = [](double x) { return std::isfinite(x); };
  if (std::all_of(pose.rotation.begin(), pose.rotation.end(), finite) &&
      std::all_of(pose.translation.begin(), pose.translation.end(), finite)) {
    return Status::Ok();
  }
  return Status::InvalidArgument("the pose is not finite");
}

Status CheckComponent(const SparseComponents& c, std::size_t k) {
  const SparseComponent& component = c.components[k];
  const auto fails = [&](const char* what) {
    return Status::InvalidArgument("component " + std::to_string(k) + ": " + what);
  };
  if (component.values.size() != component.nodes.size() * c.channels()) return fails("nodes and values disagree");
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    if (component.nodes[i] >= c.nodes()) return fails("a node that is not there");
    if (i > 0 && component.nodes[i] <= component.nodes[i - 1]) return fails("nodes are not in ascending order");
  }
  const bool finite =
      std::all_of(component.values.begin(), component.values.end(), [](float x) { return std::isfinite(x); });
  return finite ? Status::Ok() : fails("a value is not finite");
}

Status CheckComponents(const SparseComponents& c) {
  if (c.rest.empty()) return Status::InvalidArgument("the rest shape has no vertices");
  if (!MatrixOf(c.rest).allFinite()) return Status::InvalidArgument("a coordinate of the rest shape is not finite");
  for (const Triangle& t : c.triangles) {
    if (*std::max_element(t.begin(), t.end()) >= c.rest.size()) {
      return Status::InvalidArgument("a triangle has a vertex that is not there");
    }
  }
  for (const std::uint32_t v : c.still) {
    if (v >= c.rest.size()) return Status::InvalidArgument("a still vertex that is not there");
  }
  if (c.weights.size() != c.frames() * c.components.size()) {
    return Status::InvalidArgument("the weights are not frames x components");
  }
  SAC_RETURN_IF_ERROR(CheckFinite(c.weights));
  for (const RigidPose& pose : c.track) SAC_RETURN_IF_ERROR(CheckPose(pose));
  for (std::size_t k = 0; k < c.components.size(); ++k) SAC_RETURN_IF_ERROR(CheckComponent(c, k));
  return Status::Ok();
}

Status CheckWeights(std::size_t got, std::size_t wanted) {
  if (got == wanted) return Status::Ok();
  return Status::InvalidArgument(std::to_string(got) + " weights for " + std::to_string(wanted) + " components");
}

std::vector<float> FloatsOf(const Eigen::VectorXd& w) {
  std::vector<float> out(static_cast<std::size_t>(w.size()));
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<float>(w[static_cast<Eigen::Index>(k)]);
  return out;
}

Eigen::VectorXd VectorOf(std::span<const float> w) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(w.size()));
  for (std::size_t k = 0; k < w.size(); ++k) out[static_cast<Eigen::Index>(k)] = static_cast<double>(w[k]);
  return out;
}

}  // namespace

class ComponentPoser::Impl {
 public:
  ComponentModel model;
};

ComponentPoser::ComponentPoser(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ComponentPoser::~ComponentPoser() = default;

Status ComponentPoser::Create(SparseComponents components, std::unique_ptr<ComponentPoser>& poser) {
  try {
    SAC_RETURN_IF_ERROR(CheckComponents(components));
    auto impl = std::make_unique<Impl>();
    SAC_RETURN_IF_ERROR(impl->model.Prepare(std::move(components)));
    poser.reset(new ComponentPoser(std::move(impl)));
    return Status::Ok();
  } catch (const std::bad_alloc&) {
    return Status::Limit("not enough memory for these components");
  }
}

const SparseComponents& ComponentPoser::components() const { return impl_->model.components(); }

Status ComponentPoser::Compose(std::span<const float> weights, const RigidPose& pose, Positions& positions) const {
  SAC_RETURN_IF_ERROR(CheckWeights(weights.size(), components().components.size()));
  SAC_RETURN_IF_ERROR(CheckFinite(weights));
  SAC_RETURN_IF_ERROR(CheckPose(pose));
  const PositionMatrix shape = impl_->model.Shape(VectorOf(weights));
  const bool moves = pose.rotation != RigidPose{}.rotation || pose.translation != RigidPose{}.translation;
  positions = PositionsOf(moves ? Moved(shape, pose) : shape);
  return Status::Ok();
}

Status ComponentPoser::Fit(std::span<const Vec3f> shape, std::vector<float>& weights, RigidPose& pose) const {
  if (shape.size() != components().rest.size()) {
    return Status::InvalidArgument(std::to_string(shape.size()) + " vertices, not " +
                                   std::to_string(components().rest.size()));
  }
  const PositionMatrix target = MatrixOf(Positions(shape.begin(), shape.end()));
  if (!target.allFinite()) return Status::InvalidArgument("a coordinate is not finite");
  try {
    weights = FloatsOf(impl_->model.Fit(target, pose));
  } catch (const std::bad_alloc&) {  // the first fit of gradients takes the derivatives of all vertices
    return Status::Limit("not enough memory for a fit");
  }
  return Status::Ok();
}

Status ComponentPoser::Drag(std::span<const DragTarget> targets, const DragSettings& settings,
                            std::vector<float>& weights) const {
  const std::size_t count = components().components.size();
  if (!settings.start.empty()) SAC_RETURN_IF_ERROR(CheckWeights(settings.start.size(), count));
  SAC_RETURN_IF_ERROR(CheckFinite(settings.start));
  SAC_RETURN_IF_ERROR(CheckPose(settings.pose));
  if (!(settings.price >= 0) || !std::isfinite(settings.price)) {
    return Status::InvalidArgument("the price of a drag is not a number of at least 0");
  }
  for (const DragTarget& target : targets) {
    if (target.vertex >= components().rest.size()) {
      return Status::InvalidArgument("there is no vertex " + std::to_string(target.vertex) + " among " +
                                     std::to_string(components().rest.size()));
    }
    if (!MatrixOf({target.position}).allFinite()) return Status::InvalidArgument("a target is not finite");
  }
  const std::vector<float> zeros(count, 0);
  const std::vector<float>& start = settings.start.empty() ? zeros : settings.start;
  weights = FloatsOf(impl_->model.Drag(targets, settings, VectorOf(start)));
  return Status::Ok();
}

}  // namespace sac
