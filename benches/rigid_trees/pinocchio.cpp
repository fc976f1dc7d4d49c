// Pinocchio's aba and rnea of a serial arm, for turns.c. Joints rotate about z. ARM is a file with a line
// JOINT(own, x, y, z, mass, c_x, c_y, c_z, I_x, I_y, I_z) for each joint: its position in the frame of the previous
// body, and mass, centre and inertia of its own body, whose frame is rotated about x by the angle `own`.
#include <cmath>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>

using Vector = Eigen::VectorXd;
using pinocchio::SE3;

struct Joint {
    double own, x, y, z, mass, centre[3], inertia[3];
};

static const Joint joints[] = {
#define JOINT(own, x, y, z, m, a, b, c, i, j, k) {own, x, y, z, m, {a, b, c}, {i, j, k}},
#include ARM
};

static SE3 about_x(double angle) {
    return SE3(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix(), Eigen::Vector3d::Zero());
}

static pinocchio::Model arm() {
    pinocchio::Model model;
    model.gravity.linear() = Eigen::Vector3d(0, 0, -9.81);
    pinocchio::JointIndex parent = 0;
    SE3 before = SE3::Identity();
    int number = 0;
    for (const Joint &joint : joints) {
        const SE3 shift(Eigen::Matrix3d::Identity(), Eigen::Vector3d(joint.x, joint.y, joint.z));
        parent = model.addJoint(parent, pinocchio::JointModelRZ(), before * shift, "joint_" + std::to_string(++number));
        const Eigen::Vector3d centre(joint.centre[0], joint.centre[1], joint.centre[2]);
        const Eigen::Matrix3d inertia = Eigen::Vector3d(joint.inertia[0], joint.inertia[1], joint.inertia[2]).asDiagonal();
        before = about_x(joint.own);
        model.appendBodyToJoint(parent, before.act(pinocchio::Inertia(joint.mass, centre, inertia)), SE3::Identity());
    }
    return model;
}

static const pinocchio::Model model = arm();
static pinocchio::Data data(model);
static Vector q(model.nq), v(model.nv), tau(model.nv);

static void copied(const double *from, Vector &to) {
    for (Eigen::Index i = 0; i < to.size(); ++i) {
        to[i] = from[i];
    }
}

extern "C" void peer_forward(const double *state, const double *inputs, double *accelerations) {
    copied(state, q);
    copied(state + model.nq, v);
    copied(inputs, tau);
    const Vector &found = pinocchio::aba(model, data, q, v, tau);
    for (Eigen::Index i = 0; i < found.size(); ++i) {
        accelerations[i] = found[i];
    }
}

extern "C" void peer_inverse(const double *state, const double *accelerations, double *forces) {
    copied(state, q);
    copied(state + model.nq, v);
    copied(accelerations, tau);
    const Vector &found = pinocchio::rnea(model, data, q, v, tau);
    for (Eigen::Index i = 0; i < found.size(); ++i) {
        forces[i] = found[i];
    }
}
