#include "rvelab/solver/assembly/neighbour_list.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "rvelab/solver/assembly/bins.hpp"
#include "rvelab/solver/assembly/list_size.hpp"

namespace rvelab {

bool points_forward(const Image& image) {
  for (int n : image)
    if (n != 0) return n > 0;
  return false;
}

namespace {

/// Where a bin coordinate outside the cell lands, and by how many periods.
struct PeriodicBin {
  int bin, shift;
};

/// Of the bin coordinates -reach .. count - 1 + reach.
void fill_periodic_bins(int count, int reach, std::vector<PeriodicBin>& bins) {
  bins.clear();
  for (int outside = -reach; outside < count + reach; ++outside) {
    const int shift = outside >= 0 ? outside / count : -((count - 1 - outside) / count);
    bins.push_back({outside - shift * count, shift});
  }
}

/// Bins of a class that a cutoff (m) reaches over along lattice direction k.
double bins_in_reach(const Cell& cell, const Vector3& height, const SizeClass& c, double cutoff, int k) {
  return k < cell.dimension ? std::ceil(cutoff * c.count[k] / height[k] * (1 + 1e-12)) : 0;
}

/// Pairs of one grain with the grains of a class that is not larger. Within a class only half of the bins around a
/// grain are looked into, those that come after its own: a partner before it finds the pair from the other side (a list
/// of 400 discs takes 0.94 of the time that all bins take, one of 1000 spheres 0.79).
class Search {
 public:
  /// Of grains with radii up to `radius` with those of `c`.
  Search(const Cell& cell, double skin, const SizeClass& c, double radius) : cell_(cell), skin_(skin), class_(c) {
    const Vector3 height = heights(cell);
    for (int k = 0; k < 3; ++k) {
      reach_[k] = int(bins_in_reach(cell, height, c, radius + c.largest_radius + skin, k));
      fill_periodic_bins(c.count[k], reach_[k], periodic_bins_[k]);
    }
    for (int home = 0; home < c.count[0]; ++home) {
      runs_.begin_row();
      put_runs(home, 0, runs_.of_rows);
      runs_after_.begin_row();
      put_runs(home, reach_[0] + 1, runs_after_.of_rows);
    }
  }

  void find(const Placed& p, bool own_class, std::vector<ListedPair>& pairs) const {
    each_row(p, own_class, [&](std::int32_t begin, std::int32_t end, const Image& shift, std::int32_t least) {
      look_into(p.binned, begin, end, shift, least, pairs);
    });
  }

  /// Grains that find() looks at, no fewer than the partners that it finds.
  std::size_t candidates(const Placed& p, bool own_class) const {
    std::size_t count = 0;
    each_row(p, own_class, [&](std::int32_t begin, std::int32_t end, const Image&, std::int32_t) {
      count += std::size_t(end - begin);
    });
    return count;
  }

 private:
  /// Neighbouring bins along the first direction with one shift.
  struct Run {
    int first, last, shift;
  };
  /// Runs around each bin of a row, one bin after the other.
  struct Runs {
    std::vector<Run> of_rows;
    std::vector<std::size_t> begins;
    void begin_row() { begins.push_back(of_rows.size()); }
    std::span<const Run> around(std::size_t bin) const {
      const std::size_t end = bin + 1 < begins.size() ? begins[bin + 1] : of_rows.size();
      return std::span(of_rows).subspan(begins[bin], end - begins[bin]);
    }
  };

  /// Calls look(begin, end, shift, least) for the grains in rows of bins around one: those from `begin` to `end` of the
  /// class, with their images by `shift`, of numbers from `least` on.
  template <class Look>
  void each_row(const Placed& p, bool own_class, const Look& look) const {
    const SizeClass& c = class_;
    const PeriodicBin* first[3];
    for (int k = 1; k < 3; ++k) first[k] = periodic_bins_[k].data() + bin_of(p.s[k], c.count[k]);
    const int home = bin_of(p.s[0], c.count[0]);
    for (int z = own_class ? reach_[2] : 0; z <= 2 * reach_[2]; ++z)
      for (int y = own_class && z == reach_[2] ? reach_[1] : 0; y <= 2 * reach_[1]; ++y) {
        const auto look_at = [&](int bin, int last_bin, int shift, std::int32_t least) {
          look(c.begin[c.index(bin, first[1][y].bin, first[2][z].bin)],
               c.begin[c.index(last_bin, first[1][y].bin, first[2][z].bin) + 1],
               {shift, first[1][y].shift, first[2][z].shift}, least);
        };
        const bool own_row = own_class && z == reach_[2] && y == reach_[1];
        if (own_row) look_at(home, home, 0, p.binned.grain + 1);
        for (const Run& run : (own_row ? runs_after_ : runs_).around(std::size_t(home)))
          look_at(run.first, run.last, run.shift, 0);
      }
  }

  /// Bins around `home` along the first direction, from the given one on. Those that follow each other do so in memory:
  /// they are looked into as one.
  void put_runs(int home, int from, std::vector<Run>& runs) const {
    const std::size_t before = runs.size();
    for (int x = from; x <= 2 * reach_[0]; ++x) {
      const PeriodicBin& l = periodic_bins_[0][std::size_t(home + x)];
      if (runs.size() > before && runs.back().shift == l.shift && runs.back().last + 1 == l.bin)
        runs.back().last = l.bin;
      else
        runs.push_back({l.bin, l.bin, l.shift});
    }
  }

  /// Grains from number `least` on that are near enough, among those binned from `begin` to `end`.
  void look_into(const Binned& i, std::int32_t begin, std::int32_t end, const Image& shift, std::int32_t least,
                 std::vector<ListedPair>& pairs) const {
    const Binned* grains = class_.grains.data();
    const Matrix3& l = cell_.lattice;
    const double x = l(0, 0) * shift[0] + l(0, 1) * shift[1] + l(0, 2) * shift[2] - i.x[0];
    const double y = l(1, 1) * shift[1] + l(1, 2) * shift[2] - i.x[1];
    const double z = cell_.dimension == 3 ? l(2, 2) * shift[2] - i.x[2] : 0;
    const double radius = i.radius + skin_;
    // Hits are noted without a branch, since none would be predicted (with runs of bins: a list of 400 discs 24 to 18
    // steps' time, of 1000 spheres 14 to 10).
    constexpr std::int32_t most = 64;
    std::int32_t hits[most];
    for (std::int32_t from = begin; from < end; from += most) {
      const std::int32_t to = std::min(end, from + most);
      int found = 0;
      for (std::int32_t q = from; q < to; ++q) {
        const Binned& j = grains[q];
        const double dx = j.x[0] + x, dy = j.x[1] + y, dz = j.x[2] + z, reach = radius + j.radius;
        hits[found] = q;
        found += int(dx * dx + dy * dy + dz * dz < reach * reach) & int(j.grain >= least);
      }
      for (int k = 0; k < found; ++k) add(i, grains[hits[k]], shift, pairs);
    }
  }

  static void add(const Binned& i, const Binned& j, const Image& shift, std::vector<ListedPair>& pairs) {
    Image image;
    for (int k = 0; k < 3; ++k) image[k] = shift[k] - j.period[k] + i.period[k];
    if (j.grain > i.grain || (j.grain == i.grain && points_forward(image)))
      pairs.push_back({i.grain, j.grain, image});
    else
      pairs.push_back({j.grain, i.grain, {-image[0], -image[1], -image[2]}});
  }

  const Cell& cell_;
  double skin_;
  const SizeClass& class_;
  int reach_[3] = {0, 0, 0};
  std::vector<PeriodicBin> periodic_bins_[3];
  Runs runs_, runs_after_;  ///< by bin of the grain along the first direction; those after it
};

/// Puts the few pairs of one grain i in order.
void sort_by_j(ListedPair* begin, ListedPair* end) {
  for (ListedPair* next = begin; next < end; ++next) {
    const ListedPair pair = *next;
    ListedPair* to = next;
    for (; to > begin && (pair.j < to[-1].j || (pair.j == to[-1].j && pair.image < to[-1].image)); --to) *to = to[-1];
    *to = pair;
  }
}

/// By (i, j, image): counted by i, then the few of each i put in order.
std::vector<ListedPair> in_order(const std::vector<std::vector<ListedPair>>& found, std::size_t grains, Workers* team) {
  std::vector<std::uint32_t> begin(grains + 1, 0);
  for (const auto& of_piece : found)
    for (const ListedPair& pair : of_piece) ++begin[std::size_t(pair.i) + 1];
  for (std::size_t g = 0; g < grains; ++g) begin[g + 1] += begin[g];
  std::vector<ListedPair> pairs(begin[grains]);
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const auto& of_piece : found)
    for (const ListedPair& pair : of_piece) pairs[next[std::size_t(pair.i)]++] = pair;
  in_pieces(grains, team, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      ListedPair *from = pairs.data() + begin[g], *to = pairs.data() + begin[g + 1];
      if (to - from <= 32)
        sort_by_j(from, to);
      else
        std::sort(from, to);
    }
  });
  return pairs;
}

/// The grains of a list in their bins.
class Bins {
 public:
  Bins(const Cell& cell, const double* x, std::size_t stride, const std::vector<double>& radii, double skin,
       Workers* team)
      : cell_(cell), skin_(skin), team_(team), grains_(radii.size()) {
    in_pieces(radii.size(), team, [&](std::size_t, std::size_t first, std::size_t last) {
      for (std::size_t g = first; g < last; ++g) grains_[g] = placed(cell, x + stride * g, radii[g], g);
    });
    classes_ = sort_into_bins(cell, grains_, radii, skin);
  }

  /// Bins that the grains look into, at most.
  double looks() const {
    const Vector3 height = heights(cell_);
    double looks = 0;
    each_pair_of_classes([&](const SizeClass& larger, const SizeClass& smaller) {
      const double cutoff = larger.largest_radius + smaller.largest_radius + skin_;
      double around = 1;
      for (int k = 0; k < cell_.dimension; ++k) around *= 1 + 2 * bins_in_reach(cell_, height, smaller, cutoff, k);
      // Of each bin along the first direction those around it are put down once.
      const double rows = double(smaller.count[0]) * (1 + 2 * bins_in_reach(cell_, height, smaller, cutoff, 0));
      looks += around * double(larger.grains.size()) + rows;
    });
    return looks;
  }

  /// Candidates of all grains: no fewer pairs than there will be.
  double candidates() const {
    std::vector<double> of_piece;
    each_piece(of_piece, [&](Search& search, std::span<const Binned> members, bool own_class, double& count) {
      for (const Binned& member : members) count += double(search.candidates(grain_of(member), own_class));
    });
    double sum = 0;
    for (const double count : of_piece) sum += count;
    return sum;
  }

  std::vector<std::vector<ListedPair>> pairs() const {
    std::vector<std::vector<ListedPair>> of_piece;
    each_piece(of_piece, [&](Search& search, std::span<const Binned> members, bool own_class, auto& found) {
      found.reserve(members.size() * std::size_t(cell_.dimension == 2 ? 4 : 8));
      for (const Binned& member : members) search.find(grain_of(member), own_class, found);
    });
    return of_piece;
  }

 private:
  const Placed& grain_of(const Binned& member) const { return grains_[std::size_t(member.grain)]; }

  template <class Work>
  void each_pair_of_classes(const Work& work) const {
    for (std::size_t of = 0; of < classes_.size(); ++of)
      for (std::size_t with = of; with < classes_.size(); ++with)
        if (!classes_[of].grains.empty() && !classes_[with].grains.empty()) work(classes_[of], classes_[with]);
  }

  /// Calls work(search, members, own class, result) for pieces of every class with every class that is not larger.
  template <class Result, class Work>
  void each_piece(std::vector<Result>& of_piece, const Work& work) const {
    each_pair_of_classes([&](const SizeClass& larger, const SizeClass& smaller) {
      const std::span<const Binned> members = larger.grains;
      const std::size_t before = of_piece.size();
      of_piece.resize(before + pieces_in(members.size()));
      in_pieces(members.size(), team_, [&](std::size_t piece, std::size_t first, std::size_t last) {
        Search search(cell_, skin_, smaller, larger.largest_radius);
        work(search, members.subspan(first, last - first), &larger == &smaller, of_piece[before + piece]);
      });
    });
  }

  const Cell& cell_;
  double skin_;
  Workers* team_;
  std::vector<Placed> grains_;
  std::vector<SizeClass> classes_;
};

}  // namespace

double pairs_at_most(const Cell& cell, const double* x, std::size_t stride, const std::vector<double>& radii,
                     double skin) {
  return std::min(Bins(cell, x, stride, radii, skin, nullptr).candidates(), pairs_by_volume(cell, radii, skin));
}

std::vector<ListedPair> list_pairs(const Cell& cell, const double* x, std::size_t stride,
                                   const std::vector<double>& radii, double skin, Workers* team) {
  const std::size_t n = radii.size();
  if (n == 0) return {};
  expect_computable(cell);
  // What volumes say costs nothing and is enough for small assemblies; it is the bins that know a large one.
  const double by_volume = pairs_by_volume(cell, radii, skin);
  const bool many = !(by_volume <= allowed_pairs(n));
  const Bins bins(cell, x, stride, radii, skin, team);
  const double looks = bins.looks();
  if (!(looks <= allowed_looks(n))) {
    if (many) refuse_pairs(by_volume, cell, radii, skin);
    refuse_looks(looks, cell);
  }
  if (many) {
    const double candidates = std::min(bins.candidates(), by_volume);
    if (!(candidates <= allowed_pairs(n))) refuse_pairs(candidates, cell, radii, skin);
  }
  return in_order(bins.pairs(), n, team);
}

}  // namespace rvelab
