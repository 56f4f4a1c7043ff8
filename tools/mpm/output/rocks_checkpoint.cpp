// The rocks of a checkpoint: bodies, contacts with their memory, energies. Declared in rocks.hpp.
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {

/// Takes numbers one by one. Not in an anonymous namespace: lambdas of templates hold it.
class Taker {
 public:
  Taker(const std::vector<double>& values, std::string what) : values_(values), what_(std::move(what)) {}
  double operator()() {
    if (at_ < values_.size()) return values_[at_++];
    throw InputError(what_ +
                     "; leave out the --set that changes their number, or start the run anew in another folder");
  }
  bool more() const { return at_ < values_.size(); }

 private:
  const std::vector<double>& values_;
  std::string what_;
  std::size_t at_ = 0;
};

namespace {

template <class Visit>
void each_number(double& angle, const Visit& visit) {
  visit(angle);
}
template <class Visit>
void each_number(Eigen::Quaterniond& orientation, const Visit& visit) {
  for (double& x : orientation.coeffs()) visit(x);
}

template <int D, class Visit>
void each_number(Rock<D>& rock, const Visit& visit) {
  each_number(rock.body.orientation, visit);
  const auto vectors = [&](auto&... all) {
    const auto each = [&](auto& vector) {
      for (double& x : vector) visit(x);
    };
    (each(all), ...);
  };
  vectors(rock.body.centre, rock.body.velocity, rock.body.angular_momentum, rock.soil_force, rock.soil_torque,
          rock.mean_velocity, rock.mean_spin, rock.force, rock.torque, rock.mean_force, rock.mean_torque,
          rock.soil_impulse);
}

template <int D, class Visit>
void each_number(RockContact<D>& contact, const Visit& visit) {
  for (double& x : contact.tangential) visit(x);
  for (double& x : contact.dashpot) visit(x);
  visit(contact.overlap);
}

template <int D, class Visit>
void each_total(Rocks<D>& rocks, const Visit& visit) {
  for (double* value :
       {&rocks.first_energy, &rocks.contact_loss, &rocks.soil_work, &rocks.wall_work, &rocks.work_on_soil,
        &rocks.surface_loss, &rocks.ghost_loss, &rocks.ghost_mapping, &rocks.ghost_frequency, &rocks.wall_power}) {
    visit(*value);
  }
  for (auto* of_walls : {&rocks.wall_impulse, &rocks.wall_force}) {
    for (auto& each : *of_walls) {
      for (double& x : each) visit(x);
    }
  }
}

template <class Each>
std::vector<double> collected(Each&& each) {
  std::vector<double> values;
  each([&](double value) { values.push_back(value); });
  return values;
}

}  // namespace

template <int D>
void write_rocks(const Solver<D>& solver, OutputFile& file) {
  auto rocks = *solver.rocks;
  const auto put = [&](const char* name, const std::vector<double>& values) {
    file.write(name, values, {values.size()});
  };
  put("rocks", collected([&](const auto& visit) {
        for (auto& rock : rocks.all) each_number<D>(rock, visit);
      }));
  put("rock_totals", collected([&](const auto& visit) { each_total<D>(rocks, visit); }));
  put("rock_contacts", collected([&](const auto& visit) {
        for (auto& pair : rocks.pairs) {
          visit(pair.first);
          visit(pair.second);
          each_number<D>(pair.contact, visit);
        }
      }));
  put("ghost_contacts", collected([&](const auto& visit) {
        for (auto& ghost : rocks.ghosts) {
          visit(double(ghost.point));
          visit(ghost.rock);
          each_number<D>(ghost.contact, visit);
          for (const double x : ghost.velocity) visit(x);
        }
      }));
  put("ghost_radii_m", rocks.balls);
  put("surface_forces_N", collected([&](const auto& visit) {
        for (std::size_t k = 0; k < rocks.pressed.size(); ++k) {
          for (std::size_t outline_point = 0; outline_point < rocks.pressed[k].size(); ++outline_point) {
            if (rocks.pressed[k][outline_point].isZero(0)) continue;
            visit(double(k));
            visit(double(outline_point));
            for (const double x : rocks.pressed[k][outline_point]) visit(x);
          }
        }
      }));
  file.write("rock_counts", std::vector<std::int64_t>{std::int64_t(rocks.all.size()), rocks.sub_steps, rocks.left_out});
}

template <int D>
void read_rocks(Solver<D>& solver, const InputFile& file, const std::string& folder) {
  auto& rocks = *solver.rocks;
  const std::string other = folder + ": its checkpoint holds other rocks than this scene";
  const auto counts = file.read_whole("rock_counts");
  if (counts.size() != 3 || counts[0] != std::int64_t(rocks.all.size())) Taker({}, other)();
  rocks.sub_steps = long(counts[1]);
  rocks.left_out = long(counts[2]);
  const auto bodies = file.read("rocks"), totals = file.read("rock_totals");
  Taker of_bodies(bodies, other), of_totals(totals, other);
  for (auto& rock : rocks.all) each_number<D>(rock, [&](double& value) { value = of_bodies(); });
  const auto walls = walls_at<D>(solver.grid, solver.planes, solver.bodies, solver.time);
  rocks.wall_impulse.assign(walls.size(), Vec<D>::Zero());
  rocks.wall_force.assign(walls.size(), Vec<D>::Zero());
  each_total<D>(rocks, [&](double& value) { value = of_totals(); });
  const auto contacts = file.read("rock_contacts"), touching = file.read("ghost_contacts");
  rocks.pairs.clear();
  for (Taker take(contacts, other); take.more();) {
    const int first = int(take()), second = int(take());
    const int wall = second - int(rocks.all.size());
    if (first < 0 || first >= int(rocks.all.size()) || second < 0 || wall >= int(walls.size())) Taker({}, other)();
    typename Rocks<D>::Pair pair{
        first, second, rocks.constants_of(first, second, wall < 0 ? nullptr : &walls[wall]), {}};
    each_number<D>(pair.contact, [&](double& value) { value = take(); });
    rocks.pairs.push_back(pair);
  }
  rocks.ghosts.clear();
  for (Taker take(touching, other); take.more();) {
    typename Rocks<D>::Ghost ghost;
    ghost.point = long(take());
    ghost.rock = int(take());
    each_number<D>(ghost.contact, [&](double& value) { value = take(); });
    for (double& x : ghost.velocity) x = take();
    rocks.ghosts.push_back(ghost);
  }
  const auto forces = file.read("surface_forces_N");
  rocks.pressed.assign(rocks.all.size(), {});
  for (Taker take(forces, other); take.more();) {
    const auto rock = std::size_t(take()), outline_point = std::size_t(take());
    if (rock >= rocks.all.size()) Taker({}, other)();
    const auto& outline = rocks.outline(rocks.all[rock].shape, outline_spacing * solver.grid.cell.minCoeff());
    if (outline_point >= outline.size()) Taker({}, other)();
    rocks.pressed[rock].resize(outline.size(), Vec<D>::Zero());
    for (double& x : rocks.pressed[rock][outline_point]) x = take();
  }
  rocks.balls = file.read("ghost_radii_m");
  if (rocks.soil.ghosts && rocks.balls.size() != solver.points.size()) Taker({}, other)();
}

template void write_rocks<2>(const Solver<2>&, OutputFile&);
template void write_rocks<3>(const Solver<3>&, OutputFile&);
template void read_rocks<2>(Solver<2>&, const InputFile&, const std::string&);
template void read_rocks<3>(Solver<3>&, const InputFile&, const std::string&);

}  // namespace mpm
