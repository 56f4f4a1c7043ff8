// The rocks of a checkpoint: bodies, contacts with their memory, energies. Declared in rocks.hpp.
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

template <int D, class Visit>
void describe(const Visit& visit, Rock<D>& rock) {
  auto& body = rock.body;
  each_number(visit, body.orientation, body.centre, body.velocity, body.angular_momentum, rock.soil_force,
              rock.soil_torque, rock.mean_velocity, rock.mean_spin, rock.force, rock.torque, rock.mean_force,
              rock.mean_torque, rock.soil_impulse);
}

/// N, of a rock at a point of its outline on the soil.
template <int D>
struct Pressed {
  std::size_t rock = 0, point = 0;
  Vec<D> force = Vec<D>::Zero();
};

template <int D>
void archive_pressed(Archive& archive, Solver<D>& solver) {
  auto& rocks = *solver.rocks;
  std::vector<Pressed<D>> all;
  for (std::size_t k = 0; k < rocks.pressed.size(); ++k) {
    for (std::size_t n = 0; n < rocks.pressed[k].size(); ++n) {
      if (!rocks.pressed[k][n].isZero(0)) all.push_back({k, n, rocks.pressed[k][n]});
    }
  }
  archive.items("surface_forces_N", all,
                [](const auto& visit, auto& each) { each_number(visit, each.rock, each.point, each.force); });
  if (!archive.reads()) return;
  rocks.pressed.assign(rocks.all.size(), {});
  for (const auto& each : all) {
    if (each.rock >= rocks.all.size()) archive.of_another_scene("rocks", each.rock + 1, rocks.all.size());
    const auto& outline = rocks.outline(rocks.all[each.rock].shape, outline_spacing * solver.grid.cell.minCoeff());
    if (each.point >= outline.size()) archive.of_another_scene("points of a rock", each.point + 1, outline.size());
    rocks.pressed[each.rock].resize(outline.size(), Vec<D>::Zero());
    rocks.pressed[each.rock][each.point] = each.force;
  }
}

/// Of rocks with rocks and walls, and with points as balls.
template <int D>
void archive_contacts(Archive& archive, Rocks<D>& rocks, const std::vector<Wall<D>>& walls) {
  const auto describe_contact = [](const auto& visit, RockContact<D>& contact) {
    each_number(visit, contact.tangential, contact.dashpot, contact.overlap);
  };
  struct Kept {
    int first = 0, second = 0;
    RockContact<D> contact;
  };
  std::vector<Kept> all;
  for (const auto& pair : rocks.pairs) all.push_back({pair.first, pair.second, pair.contact});
  archive.items("rock_contacts", all, [&](const auto& visit, Kept& pair) {
    each_number(visit, pair.first, pair.second);
    describe_contact(visit, pair.contact);
  });
  archive.items("ghost_contacts", rocks.ghosts, [&](const auto& visit, auto& ghost) {
    each_number(visit, ghost.point, ghost.rock);
    describe_contact(visit, ghost.contact);
    each_number(visit, ghost.velocity);
  });
  if (!archive.reads()) return;
  rocks.pairs.clear();
  for (const auto& [first, second, contact] : all) {
    const int n = int(rocks.all.size()), wall = second - n;
    if (first < 0 || first >= n || second < 0 || wall >= int(walls.size()))
      archive.of_another_scene("rocks and walls", std::size_t(second), rocks.all.size() + walls.size());
    rocks.pairs.push_back(
        {first, second, rocks.constants_of(first, second, wall < 0 ? nullptr : &walls[std::size_t(wall)]), contact});
  }
}

}  // namespace

template <int D>
void archive_rocks(Archive& archive, Solver<D>& solver) {
  auto& rocks = *solver.rocks;
  std::size_t count = rocks.all.size();
  archive.numbers<std::int64_t>("rock_counts",
                                [&](const auto& visit) { each_number(visit, count, rocks.sub_steps, rocks.left_out); });
  if (count != rocks.all.size()) archive.of_another_scene("rocks", count, rocks.all.size());
  archive.numbers("rocks", [&](const auto& visit) {
    for (auto& rock : rocks.all) describe<D>(visit, rock);
  });
  const auto walls = walls_at<D>(solver.grid, solver.planes, solver.bodies, solver.time);
  if (archive.reads()) {
    rocks.wall_impulse.assign(walls.size(), Vec<D>::Zero());
    rocks.wall_force.assign(walls.size(), Vec<D>::Zero());
  }
  archive.numbers("rock_totals", [&](const auto& visit) {
    each_number(visit, rocks.first_energy, rocks.contact_loss, rocks.soil_work, rocks.wall_work, rocks.work_on_soil,
                rocks.surface_loss, rocks.ghost_loss, rocks.ghost_mapping, rocks.ghost_frequency, rocks.wall_power,
                rocks.wall_impulse, rocks.wall_force);
  });
  archive_contacts<D>(archive, rocks, walls);
  archive_pressed<D>(archive, solver);
  archive.list("ghost_radii_m", rocks.balls);
  if (archive.reads() && rocks.soil.ghosts && rocks.balls.size() != solver.points.size())
    archive.of_another_scene("balls of points", rocks.balls.size(), solver.points.size());
}

template void archive_rocks<2>(Archive&, Solver<2>&);
template void archive_rocks<3>(Archive&, Solver<3>&);

}  // namespace mpm
