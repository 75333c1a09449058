// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/cross_check/engine.hpp"

namespace cross_check {

namespace {

/// The first warning of MuJoCo, which would otherwise go to a file in the current folder.
std::string& first_warning() {
  static std::string text;
  return text;
}

std::string text_of(const Vector3d& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

std::string text_of(const Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

std::string integrator_of(Method method) {
  if (method == Method::mujoco_rk4) return "RK4";
  return method == Method::mujoco_implicit ? "implicit" : "Euler";
}

/// Coefficient of restitution of a spring and damper that pushes only, by the share of critical damping (Schwager &
/// Pöschel, Granular Matter 9, 2007, eq. 21, in the branch of light damping).
double restitution_of(double damping_ratio) {
  const double ratio = damping_ratio / std::sqrt(1 - damping_ratio * damping_ratio);
  return std::exp(-ratio * (std::numbers::pi - std::atan2(2 * ratio, 1 - ratio * ratio)));
}

/// Inverse of restitution_of(), for 0.3 to 1.
double damping_ratio_for(double restitution) {
  double low = 0, high = 0.7;
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return low;
}

/// Attributes of a geom.  MuJoCo has no coefficient of restitution: a contact with one is a spring and damper of its
/// default time constant with the damping that gives it.
std::string geom_of(const Solid& solid) {
  std::string shape;
  switch (solid.shape) {
    case Solid::Shape::box:
      shape = fmt::format("type='box' size='{}'", text_of(Vector3d(solid.size_m / 2)));
      break;
    case Solid::Shape::sphere:
      shape = fmt::format("type='sphere' size='{}'", solid.radius_m);
      break;
    case Solid::Shape::cylinder:
      shape = fmt::format("type='cylinder' size='{} {}'", solid.radius_m, solid.length_m / 2);
  }
  return fmt::format("<geom {} mass='{}'", shape, solid.mass_kg);
}

std::string contact_of(const Ground& ground) {
  std::string contact = fmt::format(" friction='{} 0 0'", ground.friction);
  if (ground.friction == 0) contact += " condim='1'";
  if (ground.restitution > 0)
    contact += fmt::format(" solref='0.02 {}' solimp='0.95 0.95 0.001'", damping_ratio_for(ground.restitution));
  return contact;
}

/// A body and those that hang from it.
std::string body_of(const Model& model, int number, const Pose& X_WP) {
  const BodyModel& body = model.bodies[static_cast<std::size_t>(number)];
  const Pose X_PC = X_WP.inverse() * body.X_WC;
  std::string text = fmt::format("<body name='{}' pos='{}' quat='{}'>", number, text_of(Vector3d(X_PC.translation())),
                                 text_of(Matrix3d(X_PC.linear())));
  // The joint.
  if (!body.pivot) {
    text += "<freejoint/>";
  } else {
    const Vector3d anchor_C = body.X_WC.inverse() * body.pivot->anchor_W;
    const bool hinge = body.pivot->kind == Pivot::Kind::hinge;
    text += fmt::format("<joint type='{}' pos='{}'", hinge ? "hinge" : "ball", text_of(anchor_C));
    if (hinge)
      text += fmt::format(" axis='{}' stiffness='{}' damping='{}' springref='{}'",
                          text_of(Vector3d(body.X_WC.linear().transpose() * body.pivot->axis_W)),
                          body.pivot->stiffness_Nmprad, body.pivot->damping_Nmsprad, body.pivot->rest_rad);
    text += "/>";
  }
  // The solid.
  text += geom_of(body.solid);
  if (body.pivot || !model.ground)
    text += " contype='0' conaffinity='0'/>";
  else
    text += contact_of(*model.ground) + "/>";
  // What hangs from it.
  for (int other = number + 1; other < static_cast<int>(model.bodies.size()); ++other) {
    const auto& pivot = model.bodies[static_cast<std::size_t>(other)].pivot;
    if (pivot && pivot->parent == number) text += body_of(model, other, body.X_WC);
  }
  return text + "</body>\n";
}

/// The model in MJCF.
std::string mjcf_of(Method method, const Model& model, double step_s) {
  std::string text = fmt::format(
      "<mujoco><compiler angle='radian'/><option timestep='{}' integrator='{}' gravity='0 0 {}'/><worldbody>\n", step_s,
      integrator_of(method), -model.gravity_mps2);
  if (model.ground)
    text += fmt::format("<geom type='plane' size='0 0 1' quat='{}'{}/>\n", text_of(model.ground->R_WG()),
                        contact_of(*model.ground));
  for (int number = 0; number < static_cast<int>(model.bodies.size()); ++number) {
    const auto& pivot = model.bodies[static_cast<std::size_t>(number)].pivot;
    if (!pivot || pivot->parent < 0) text += body_of(model, number, Pose::Identity());
  }
  return text + "</worldbody></mujoco>\n";
}

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct FilesDeleter {
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};

std::unique_ptr<mjModel, ModelDeleter> compile(const std::string& mjcf) {
  // MuJoCo reads only files; these are in memory.
  const std::unique_ptr<mjVFS, FilesDeleter> files(new mjVFS);
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(mjcf.size())) != 0)
    throw std::runtime_error("MuJoCo: cannot hold the model in memory");
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "model.xml")], mjcf.data(), mjcf.size());
  char error[1000] = "";
  std::unique_ptr<mjModel, ModelDeleter> model(mj_loadXML("model.xml", files.get(), error, sizeof error));
  if (!model) throw std::runtime_error("MuJoCo: " + std::string(error) + " in\n" + mjcf);
  return model;
}

class MujocoEngine final : public Engine {
 public:
  MujocoEngine(Method method, const Model& model, double step_s)
      : model_(compile(mjcf_of(method, model, step_s))), data_(mj_makeData(model_.get())) {
    first_warning().clear();
    mju_user_warning = [](const char* text) {
      if (first_warning().empty()) first_warning() = text;
    };
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
      bodies_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, std::to_string(i).c_str()));
      start(model, static_cast<int>(i));
    }
  }

  void step() override {
    mj_step(model_.get(), data_.get());
    if (!first_warning().empty()) throw Diverged("MuJoCo: " + first_warning());
  }

  BodyState state(int body) const override {
    // A step leaves the poses of its start; these are those of its end.
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    const int id = bodies_[static_cast<std::size_t>(body)];
    mjtNum velocity[6];
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, id, velocity, 0);
    BodyState state;
    state.R_WC = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * id);
    state.p_WC = Eigen::Map<const Vector3d>(data_->xpos + 3 * id);
    state.w_W = Eigen::Map<const Vector3d>(velocity);
    state.v_WC_W = Eigen::Map<const Vector3d>(velocity + 3);
    return state;
  }

 private:
  void start(const Model& model, int number) {
    const BodyModel& body = model.bodies[static_cast<std::size_t>(number)];
    mjtNum* qvel = data_->qvel + model_->body_dofadr[bodies_[static_cast<std::size_t>(number)]];
    const int parent = body.pivot ? body.pivot->parent : -1;
    const Vector3d w_parent_W =
        parent < 0 ? Vector3d::Zero().eval() : model.bodies[static_cast<std::size_t>(parent)].w_W;
    const Vector3d w_W = body.w_W - w_parent_W;
    const Vector3d w_C = body.X_WC.linear().transpose() * w_W;
    if (!body.pivot) {
      Eigen::Map<Vector3d>{qvel} = body.v_WC_W;
      Eigen::Map<Vector3d>{qvel + 3} = w_C;
    } else if (body.pivot->kind == Pivot::Kind::ball) {
      Eigen::Map<Vector3d>{qvel} = w_C;
    } else {
      *qvel = body.pivot->axis_W.dot(w_W);
    }
  }

  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::vector<int> bodies_;
};

}  // namespace

std::string mujoco_version() {
  return fmt::format("{}.{}.{}", mjVERSION_HEADER / 100, mjVERSION_HEADER / 10 % 10, mjVERSION_HEADER % 10);
}

std::unique_ptr<Engine> make_mujoco(Method method, const Model& model, double step_s) {
  return std::make_unique<MujocoEngine>(method, model, step_s);
}

}  // namespace cross_check
