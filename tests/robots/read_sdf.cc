// SPDX-FileCopyrightText: 2026 Body Moments contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What Gazebo's own parser, libsdformat, makes of the files that it is given, as lines for tests/robots/test_sdf_parser.py.
#include <cstdio>
#include <cstring>

#include <sdf/Collision.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#include <sdf/Visual.hh>

// Print the pose of a shape in its link.
static void PrintShape(const std::string &link, const std::string &name, const sdf::SemanticPose &semantic)
{
  ignition::math::Pose3d pose;
  for (const auto &error : semantic.Resolve(pose))
    std::printf("error\t%d\t%s\n", static_cast<int>(error.Code()), error.Message().c_str());
  const auto &turn = pose.Rot();
  std::printf("shape\t%s\t%s\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\n", link.c_str(), name.c_str(), pose.Pos().X(),
      pose.Pos().Y(), pose.Pos().Z(), turn.W(), turn.X(), turn.Y(), turn.Z());
}

// Print the poses of all shapes in the links of a model and of the models in it.
static void PrintShapes(const sdf::Model &model)
{
  for (uint64_t number = 0; number < model.LinkCount(); ++number)
  {
    const auto *link = model.LinkByIndex(number);
    const auto name = model.Name() + "::" + link->Name();
    for (uint64_t index = 0; index < link->VisualCount(); ++index)
      PrintShape(name, "visual", link->VisualByIndex(index)->SemanticPose());
    for (uint64_t index = 0; index < link->CollisionCount(); ++index)
      PrintShape(name, "collision", link->CollisionByIndex(index)->SemanticPose());
  }
  for (uint64_t number = 0; number < model.ModelCount(); ++number)
    PrintShapes(*model.ModelByIndex(number));
}

int main(int count, char **arguments)
{
  const bool shapes = count > 1 && !std::strcmp(arguments[1], "--shapes");
  for (int index = shapes ? 2 : 1; index < count; ++index)
  {
    sdf::Root root;
    for (const auto &error : root.Load(arguments[index]))
      std::printf("error\t%d\t%s\n", static_cast<int>(error.Code()), error.Message().c_str());
    const auto *model = root.Model();
    if (model && shapes)
      PrintShapes(*model);
    if (!model || shapes)
      continue;
    for (uint64_t number = 0; number < model->LinkCount(); ++number)
    {
      const auto *link = model->LinkByIndex(number);
      const auto &inertial = link->Inertial();
      const auto tensor = inertial.Moi();
      const auto center = inertial.Pose().Pos();
      std::printf("link\t%s\t%.17g\t%.17g\t%.17g\t%.17g", link->Name().c_str(), inertial.MassMatrix().Mass(), center.X(),
          center.Y(), center.Z());
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          std::printf("\t%.17g", tensor(i, j));
      ignition::math::Pose3d pose;
      for (const auto &error : link->SemanticPose().Resolve(pose, "__model__"))
        std::printf("error\t%d\t%s\n", static_cast<int>(error.Code()), error.Message().c_str());
      const auto turn = pose.Rot();
      std::printf("\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\n", pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z(),
          turn.W(), turn.X(), turn.Y(), turn.Z());
    }
    for (uint64_t number = 0; number < model->JointCount(); ++number)
    {
      const auto *joint = model->JointByIndex(number);
      ignition::math::Pose3d pose;
      for (const auto &error : joint->SemanticPose().Resolve(pose, "__model__"))
        std::printf("error\t%d\t%s\n", static_cast<int>(error.Code()), error.Message().c_str());
      std::printf("joint\t%s\t%d\t%s\t%s\t%.17g\t%.17g\t%.17g\n", joint->Name().c_str(),
          static_cast<int>(joint->Type()), joint->ParentLinkName().c_str(), joint->ChildLinkName().c_str(), pose.Pos().X(),
          pose.Pos().Y(), pose.Pos().Z());
    }
  }
  return 0;
}
