// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <vector>

namespace sim {

struct Geodesy::Impl {
  GeographicLib::LocalCartesian local;
};

Geodesy::Geodesy(const GeodeticPosition& origin)
    : impl_(new Impl{GeographicLib::LocalCartesian(origin.latitude_deg, origin.longitude_deg, origin.height_m)}) {}

Geodesy::~Geodesy() = default;

GeodeticPosition Geodesy::to_geodetic(const Vector3d& p_W) const {
  GeodeticPosition out;
  impl_->local.Reverse(p_W.x(), p_W.y(), p_W.z(), out.latitude_deg, out.longitude_deg, out.height_m);
  return out;
}

Matrix3d Geodesy::local_axes_W(const Vector3d& p_W) const {
  GeodeticPosition place;
  std::vector<GeographicLib::Math::real> by_rows(9);
  impl_->local.Reverse(p_W.x(), p_W.y(), p_W.z(), place.latitude_deg, place.longitude_deg, place.height_m, by_rows);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(by_rows.data());
}

Vector3d Geodesy::to_local(const GeodeticPosition& position) const {
  Vector3d out;
  impl_->local.Forward(position.latitude_deg, position.longitude_deg, position.height_m, out.x(), out.y(), out.z());
  return out;
}

}  // namespace sim
