// States as ParaView reads them: an XDMF file, and beside it an HDF5 file with the arrays. Declared in export.hpp.
#include "rvelab/io/export/export.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::io {
namespace {

/// How XDMF calls a scalar type.
template <class Scalar>
constexpr const char* number_type = std::is_same_v<Scalar, double>         ? "NumberType=\"Float\" Precision=\"8\""
                                    : std::is_same_v<Scalar, std::uint8_t> ? "NumberType=\"UChar\" Precision=\"1\""
                                    : std::is_same_v<Scalar, std::int32_t> ? "NumberType=\"Int\" Precision=\"4\""
                                                                           : "NumberType=\"Int\" Precision=\"8\"";

/// Writes arrays into the heavy file and the light text that points to them.
class Series {
 public:
  Series(Hdf5File& heavy, const std::string& heavy_name) : heavy_(heavy), heavy_name_(heavy_name) {}

  void add(const ExportState& state, std::size_t number, double time) {
    group_ = "/state_" + std::to_string(number);
    text += "   <Grid Name=\"state " + std::to_string(number) +
            "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n    <Time Value=\"" + exact(time) + "\"/>\n";
    add_grains(state);
    if (!state.network.contacts.empty()) add_contacts(state);
    each_interaction_law([&](auto, auto law) { add_interactions<decltype(law)>(state); });
    add_cell(state);
    text += "   </Grid>\n";
  }

  std::string text;

 private:
  template <class Scalar>
  std::string item(const std::string& name, const std::vector<Scalar>& values, std::size_t components,
                   const std::string& units) {
    const std::size_t rows = values.size() / components;
    const Shape64 shape = components == 1 ? Shape64{rows} : Shape64{rows, components};
    heavy_.write<Scalar>(group_ + "/" + name, values, shape, units);
    const std::string extents = std::to_string(rows) + (components == 1 ? "" : " " + std::to_string(components));
    return std::string("<DataItem Format=\"HDF\" ") + number_type<Scalar> + " Dimensions=\"" + extents + "\">" +
           heavy_name_ + ":" + group_ + "/" + name + "</DataItem>";
  }

  template <class Scalar>
  void attribute(const char* block, const char* name, const char* center, const std::vector<Scalar>& values,
                 std::size_t components, const char* units) {
    const char* type = components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor";
    text += std::string("     <Attribute Name=\"") + name + "\" AttributeType=\"" + type + "\" Center=\"" + center +
            "\">" + item(std::string(block) + "/" + name, values, components, units) + "</Attribute>\n";
  }

  void begin(const char* block, const std::string& topology, const std::vector<double>& points) {
    text += std::string("    <Grid Name=\"") + block + "\" GridType=\"Uniform\">\n     " + topology +
            "\n     <Geometry GeometryType=\"XYZ\">" + item(std::string(block) + "/points_m", points, 3, "m") +
            "</Geometry>\n";
  }
  void end() { text += "    </Grid>\n"; }

  /// Two points a line, in the order of the points.
  std::string lines(const char* block, std::size_t count) {
    std::vector<std::int32_t> ends(2 * count);
    for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = std::int32_t(k);
    return "<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"" + std::to_string(count) +
           "\">" + item(std::string(block) + "/ends", ends, 2, "1") + "</Topology>";
  }

  static void append(std::vector<double>& values, const Vector3& vector) {
    for (int k = 0; k < 3; ++k) values.push_back(vector[k]);
  }

  /// Of superellipsoids the quaternion of their axes, scalar first, and R diag(half axes) R^T, from which ParaView's
  /// filter Tensor Glyph draws ellipsoids as they are; both in the laboratory frame.
  void add_solids(const ExportState& state) {
    std::vector<double> quaternion, tensor;
    for (std::size_t g = 0; g < state.specimen.grains.size(); ++g) {
      const Turn q = after(turn_of(state.network.cell.rotation), state.specimen.bodies[g].orientation);
      quaternion.insert(quaternion.end(), {q.w, q.v[0], q.v[1], q.v[2]});
      const OwnValues own = own_of<SuperellipsoidGrain>(state.specimen.grains, g);
      const Matrix3 axes = axes_of(q);
      const Matrix3 half = axes * Vector3(own.half_x, own.half_y, own.half_z).asDiagonal() * axes.transpose();
      for (int k = 0; k < 9; ++k) tensor.push_back(half(k / 3, k % 3));
    }
    attribute("grains", "quaternion", "Node", quaternion, 4, "1");
    attribute("grains", "half_axes_m", "Node", tensor, 9, "m");
  }

  /// Of grains that are not round: the long axis, laboratory frame, and the lengths of the shape.
  template <class By>
  void add_outlines(const ExportState& state) {
    std::vector<double> orientation;
    for (const GrainState& grain : state.network.grains)
      append(orientation, state.network.cell.rotation * grain.orientation);
    attribute("grains", "orientation", "Node", orientation, 3, "1");
    each_column_of<By>(
        [&](const auto& described, const std::vector<double>& column) {
          attribute("grains", described.dataset, "Node", column, 1, described.unit);
        },
        state.specimen.grains);
    if constexpr (By::rigid) add_solids(state);
  }

  void add_grains(const ExportState& state) {
    const Network& network = state.network;
    const Matrix3& turn = network.cell.rotation;
    const Box box(network.cell.lattice);
    const double physical = network.loading == Loading::quasi_static ? 0 : 1;
    std::vector<double> points, radius, velocity, spin, stress;
    for (const GrainState& grain : network.drawn()) {
      append(points, turn * box.wrapped(grain.position));
      radius.push_back(grain.radius);
      append(velocity, physical * (turn * grain.velocity));
      append(spin, physical * (turn * grain.spin));
    }
    // Of bodies (clumps) members are drawn, with what their body has.
    const auto stresses = grain_stresses(network);
    const auto counts = contact_counts(network);
    std::vector<std::int32_t> contacts;
    for (std::size_t g = 0; g < network.drawn().size(); ++g) {
      const auto of = network.has_bodies() ? std::size_t(network.owner[g]) : g;
      const Matrix3& sigma = stresses[of];
      contacts.push_back(counts[of]);
      for (int k = 0; k < 9; ++k) stress.push_back(sigma(k / 3, k % 3));
    }
    begin("grains",
          "<Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"" +
              std::to_string(network.drawn().size()) + "\"/>",
          points);
    attribute("grains", "radius_m", "Node", radius, 1, "m");
    with_shape(network.shape, [&](auto is) {
      if constexpr (!decltype(is)::By::round) add_outlines<typename decltype(is)::By>(state);
    });
    attribute("grains", "id", "Node", state.specimen.grains.id, 1, "1");
    attribute("grains", "material", "Node", state.specimen.grains.material, 1, "1");
    attribute("grains", "fluctuation_velocity_m_s", "Node", velocity, 3, "m/s");
    attribute("grains", "fluctuation_spin_rad_s", "Node", spin, 3, "rad/s");
    attribute("grains", "stress_Pa", "Node", stress, 9, "Pa");
    attribute("grains", "contacts", "Node", contacts, 1, "1");
    if (network.has_bodies()) {
      std::vector<std::int64_t> bodies;
      for (const std::int32_t owner : network.owner) bodies.push_back(state.specimen.bodies[std::size_t(owner)].id);
      attribute("grains", "body", "Node", bodies, 1, "1");
    }
    end();
  }

  void add_contacts(const ExportState& state) {
    const Network& network = state.network;
    const Matrix3& turn = network.cell.rotation;
    const Box box(network.cell.lattice);
    std::vector<double> points, force, normal_force, overlap;
    std::vector<std::uint8_t> sliding;
    for (const ContactState& contact : network.contacts) {
      const Vector3 from = box.wrapped(network.grains[std::size_t(contact.i)].position);
      append(points, turn * from);
      append(points, turn * (from + contact.branch));
      append(force, turn * contact.force());
      normal_force.push_back(contact.normal_force);
      overlap.push_back(contact.overlap);
      sliding.push_back(is_sliding(contact) ? 1 : 0);
    }
    begin("contacts", lines("contacts", network.contacts.size()), points);
    attribute("contacts", "force_N", "Cell", force, 3, "N");
    attribute("contacts", "normal_force_N", "Cell", normal_force, 1, "N");
    attribute("contacts", "overlap_m", "Cell", overlap, 1, "m");
    attribute("contacts", "sliding", "Cell", sliding, 1, "1");
    end();
  }

  /// All of a kind, broken bonds too, as lines between the centres with what the law keeps.
  template <class Law>
  void add_interactions(const ExportState& state) {
    const auto& items = static_cast<const ListOf<Law>&>(state.specimen).items;
    if (items.empty()) return;
    const Cell& cell = state.network.cell;
    const Box box(cell.lattice);
    const auto& at = state.specimen.grains.position;
    std::vector<double> points;
    for (const Interaction<Law>& item : items) {
      const auto i = std::size_t(item.i), j = std::size_t(item.j);
      const Vector3 from = box.wrapped(at[i]);
      append(points, cell.rotation * from);
      append(points, cell.rotation * (from + (at[j] + translation(cell, item.image) - at[i])));
    }
    const auto tangent_of = [&](const Interaction<Law>& item) -> Vector3 {
      const Vector3 n =
          (at[std::size_t(item.j)] + translation(cell, item.image) - at[std::size_t(item.i)]).stableNormalized();
      return {-n.y(), n.x(), 0};
    };
    begin(Law::name, lines(Law::name, items.size()), points);
    std::size_t field = 0;
    each_field<Law>(items.front(), [&](const InteractionField& described, const auto&) {
      std::vector<double> values;
      for (const Interaction<Law>& item : items) {
        std::size_t k = 0;
        each_field<Law>(item, [&](const InteractionField&, const auto& value) {
          if (k++ != field) return;
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
            values.push_back(value);
          else if (described.turning == Turning::tangent && cell.dimension == 2)  // a component; arrows need the vector
            append(values, cell.rotation * (value[0] * tangent_of(item)));
          else
            append(values, in_laboratory(described, value, cell));
        });
      }
      attribute(Law::name, described.name, "Cell", values, values.size() / items.size(), described.unit);
      ++field;
    });
    end();
  }

  void add_cell(const ExportState& state) {
    const Cell& cell = state.network.cell;
    const Box box(cell.lattice);
    const int dimension = cell.dimension;
    // 2D: the mid-plane, where the centres lie.
    const Vector3 corner = box.corner() + (dimension == 2 ? Vector3(0.5 * cell.lattice.col(2)) : Vector3::Zero());
    std::vector<double> points;
    for (int axis = 0; axis < dimension; ++axis) {
      for (int others = 0; others < (dimension == 2 ? 2 : 4); ++others) {
        Vector3 start = corner;
        for (int k = 0, bit = 1; k < dimension; ++k) {
          if (k == axis) continue;
          if ((others & bit) != 0) start += cell.lattice.col(k);
          bit <<= 1;
        }
        append(points, cell.rotation * start);
        append(points, cell.rotation * (start + cell.lattice.col(axis)));
      }
    }
    begin("cell", lines("cell", points.size() / 6), points);
    end();
  }

  static bool is_sliding(const ContactState& contact) {
    return contact.tangential_force.norm() >= (1 - 1e-6) * contact.friction * std::abs(contact.pressing_force);
  }

  Hdf5File& heavy_;
  std::string heavy_name_, group_;
};

/// A file name as XML text.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char letter : name) {
    text += letter == '&'   ? std::string("&amp;")
            : letter == '<' ? std::string("&lt;")
            : letter == '>' ? std::string("&gt;")
                            : std::string(1, letter);
  }
  return text;
}

}  // namespace

namespace {

/// The strain where it never falls from state to state; else, of cycles and of several stages, the number of the
/// record.
std::vector<double> times_of(const std::vector<ExportState>& states) {
  std::vector<double> strains, records;
  for (const ExportState& state : states) {
    strains.push_back(state.strain);
    records.push_back(static_cast<double>(state.record));
  }
  return std::is_sorted(strains.begin(), strains.end()) && strains.front() < strains.back() ? strains : records;
}

}  // namespace

void export_xdmf(const std::vector<ExportState>& states, const std::string& path) {
  const std::string heavy_path = path + ".h5";
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n"
      "  <Grid Name=\"rvelab\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  publish(heavy_path, [&](Hdf5File& heavy) {
    Series series(heavy, escaped(std::filesystem::path(heavy_path).filename().string()));
    const std::vector<double> times = times_of(states);
    for (std::size_t k = 0; k < states.size(); ++k) series.add(states[k], k, times[k]);
    text += series.text;
  });
  publish_text(path, text + "  </Grid>\n </Domain>\n</Xdmf>\n");
}

}  // namespace rvelab::io
