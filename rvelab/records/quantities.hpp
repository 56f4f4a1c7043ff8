// The table of the quantities of a record beside strain and stress. Records, record files and journals, the key
// output.quantities, the events of stages (scalars only) and the program's --json use this table.
//
// A new quantity is a struct (form: quantity.hpp) and an entry in the list.
#pragma once

#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/records/energy_quantities.hpp"
#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

// Quantities of how grains are packed (rvelab/measure/measures.hpp).

struct VoidRatio {
  double void_ratio = 0;
  static constexpr QuantityText text{"void_ratio", "1", "overlaps not subtracted", true};
  static constexpr auto member = &VoidRatio::void_ratio;
  static double measure(const MeasuredState& state) { return rvelab::void_ratio(state.network); }
};

struct CoordinationNumber {
  double coordination_number = 0;
  static constexpr QuantityText text{"coordination_number", "1", "2 Nc/N, all grains", true};
  static constexpr auto member = &CoordinationNumber::coordination_number;
  static double measure(const MeasuredState& state) { return rvelab::coordination_number(state.network); }
};

struct SlidingFraction {
  double sliding_fraction = 0;
  static constexpr QuantityText text{"sliding_fraction", "1", "contacts on the Coulomb cone", true};
  static constexpr auto member = &SlidingFraction::sliding_fraction;
  static double measure(const MeasuredState& state) { return rvelab::sliding_fraction(state.network); }
};

struct MechanicalVoidRatio {
  double mechanical_void_ratio = 0;
  static constexpr QuantityText text{"mechanical_void_ratio", "1", "rattlers counted as voids"};
  static constexpr auto member = &MechanicalVoidRatio::mechanical_void_ratio;
  static double measure(const MeasuredState& state) { return rvelab::mechanical_void_ratio(state.network); }
};

struct MechanicalCoordinationNumber {
  double mechanical_coordination_number = 0;
  static constexpr QuantityText text{"mechanical_coordination_number", "1", "without rattlers and their contacts"};
  static constexpr auto member = &MechanicalCoordinationNumber::mechanical_coordination_number;
  static double measure(const MeasuredState& state) { return rvelab::mechanical_coordination_number(state.network); }
};

struct TouchingNeighbours {
  double touching_neighbours = 0;
  static constexpr QuantityText text{"touching_neighbours", "1", "2 Np/N, Np pairs of grains, of clumps, that touch"};
  static constexpr auto member = &TouchingNeighbours::touching_neighbours;
  static double measure(const MeasuredState& state) { return rvelab::touching_neighbours(state.network); }
};

// Quantities of the directions of contacts and grains, laboratory frame (rvelab/measure/measures.hpp).

struct Fabric {
  Matrix3 fabric = Matrix3::Zero();
  static constexpr QuantityText text{"fabric", "1", "mean of n (x) n over the contacts"};
  static constexpr auto member = &Fabric::fabric;
  static Matrix3 measure(const MeasuredState& state) { return rvelab::fabric(state.network); }
};

struct BranchFabric {
  Matrix3 branch_fabric = Matrix3::Zero();
  static constexpr QuantityText text{"branch_fabric", "1", "sum b (x) b / sum b.b"};
  static constexpr auto member = &BranchFabric::branch_fabric;
  static Matrix3 measure(const MeasuredState& state) { return rvelab::branch_fabric(state.network); }
};

struct OrientationFabric {
  Matrix3 orientation_fabric = Matrix3::Zero();
  static constexpr QuantityText text{"orientation_fabric", "1",
                                     "ellipses: mean of e (x) e over the grains, e along the long axis; NaN if round"};
  static constexpr auto member = &OrientationFabric::orientation_fabric;
  static Matrix3 measure(const MeasuredState& state) { return rvelab::orientation_fabric(state.network); }
};

struct FabricAnisotropy {
  double fabric_anisotropy = 0;
  static constexpr QuantityText text{"fabric_anisotropy", "1", "of contact normals", true};
  static constexpr auto member = &FabricAnisotropy::fabric_anisotropy;
  static double measure(const MeasuredState& state) {
    return rvelab::fabric_anisotropy(fabric(state.network), state.network.dimension());
  }
};

// Parts of the stress, laboratory frame, tension positive; both together are that of the record.

struct ContactStress {
  Matrix3 contact_stress = Matrix3::Zero();
  static constexpr QuantityText text{"contact_stress_Pa", "Pa", "of the forces of contacts and bonds"};
  static constexpr auto member = &ContactStress::contact_stress;
  static Matrix3 measure(const MeasuredState& state) { return state.rve.contact_stress(); }
};

struct ReynoldsStress {
  Matrix3 reynolds_stress = Matrix3::Zero();
  static constexpr QuantityText text{"reynolds_stress_Pa", "Pa", "of the fluctuations alone"};
  static constexpr auto member = &ReynoldsStress::reynolds_stress;
  static Matrix3 measure(const MeasuredState& state) { return state.rve.reynolds_stress(); }
};

// Energies of the whole cell (rvelab/measure/measures.hpp).

struct ElasticEnergy {
  double elastic_energy = 0;
  static constexpr QuantityText text{"elastic_energy_J", "J", "in the springs of contacts and bonds"};
  static constexpr auto member = &ElasticEnergy::elastic_energy;
  static double measure(const MeasuredState& state) { return rvelab::elastic_energy(state.network); }
};

struct KineticEnergy {
  double kinetic_energy = 0;
  static constexpr QuantityText text{"kinetic_energy_J", "J",
                                     "of fluctuation velocities and whole spins; 0 when quasi-static"};
  static constexpr auto member = &KineticEnergy::kinetic_energy;
  static double measure(const MeasuredState& state) { return rvelab::kinetic_energy(state.network); }
};

// Anisotropies along the deviator of the stress, and the stress that they predict (rvelab/measure/anisotropy.hpp).

struct ContactAnisotropy {
  double a_c = 0;
  static constexpr QuantityText text{"a_c", "1", "anisotropy of contact normals along the stress"};
  static constexpr auto member = &ContactAnisotropy::a_c;
  static double measure(const MeasuredState& state) { return state.relation().a_c; }
};

struct NormalForceAnisotropy {
  double a_n = 0;
  static constexpr QuantityText text{"a_n", "1", "of normal forces"};
  static constexpr auto member = &NormalForceAnisotropy::a_n;
  static double measure(const MeasuredState& state) { return state.relation().a_n; }
};

struct TangentialForceAnisotropy {
  double a_t = 0;
  static constexpr QuantityText text{"a_t", "1", "of tangential forces"};
  static constexpr auto member = &TangentialForceAnisotropy::a_t;
  static double measure(const MeasuredState& state) { return state.relation().a_t; }
};

struct BranchAnisotropy {
  double a_l = 0;
  static constexpr QuantityText text{"a_l", "1", "of branches along the normals"};
  static constexpr auto member = &BranchAnisotropy::a_l;
  static double measure(const MeasuredState& state) { return state.relation().a_l; }
};

struct TangentialBranchAnisotropy {
  double a_lt = 0;
  static constexpr QuantityText text{"a_lt", "1", "of branches across the normals, 0 of round grains"};
  static constexpr auto member = &TangentialBranchAnisotropy::a_lt;
  static double measure(const MeasuredState& state) { return state.relation().a_lt; }
};

struct StressForceFabricRatio {
  double stress_force_fabric = 0;
  static constexpr QuantityText text{"stress_force_fabric", "1",
                                     "q/p predicted from the distributions of contact normals, forces and branches"};
  static constexpr auto member = &StressForceFabricRatio::stress_force_fabric;
  static double measure(const MeasuredState& state) { return state.relation().predicted; }
};

struct FabricAngle {
  double fabric_angle_deg = 0;
  static constexpr QuantityText text{"fabric_angle_deg", "degrees",
                                     "between the major axes of stress and contact normals"};
  static constexpr auto member = &FabricAngle::fabric_angle_deg;
  static double measure(const MeasuredState& state) {
    return axes_angle_deg(-state.rve.stress(), rvelab::fabric(state.network), state.network.dimension());
  }
};

// Contacts with a normal force above the mean (rvelab/measure/force_networks.hpp).

struct StrongContacts {
  double strong_contacts = 0;
  static constexpr QuantityText text{"strong_contacts", "1", "share of contacts above the mean normal force"};
  static constexpr auto member = &StrongContacts::strong_contacts;
  static double measure(const MeasuredState& state) { return state.networks().strong.contacts; }
};

struct StrongDeviator {
  double strong_deviator = 0;
  static constexpr QuantityText text{"strong_deviator", "1", "share of q that these bear"};
  static constexpr auto member = &StrongDeviator::strong_deviator;
  static double measure(const MeasuredState& state) { return state.networks().strong.deviator_share; }
};

// Bonds (rvelab/interaction: beam.hpp, contact_bond.hpp).

/// Sum of `of(Law{}, columns)` over all bonds.
template <class Of>
double sum_over_bonds(const MeasuredState& state, const Of& of) {
  double sum = 0;
  const Interactions all = state.rve.interactions();
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (Law::family == Family::bonds) {
      double columns[interaction_columns<Law>()];
      for (const auto& bond : static_cast<const ListOf<Law>&>(all).items) {
        put_columns<Law>(bond, columns);
        sum += of(law, columns);
      }
    }
  });
  return sum;
}
inline double bonds_with(const MeasuredState& state, double broken) {
  return sum_over_bonds(state,
                        [=](auto law, const double* c) { return c[decltype(law)::broken] == broken ? 1.0 : 0.0; });
}

struct Bonds {
  double bonds = 0;
  static constexpr QuantityText text{"bonds", "1", "intact ones"};
  static constexpr auto member = &Bonds::bonds;
  static double measure(const MeasuredState& state) { return bonds_with(state, 0); }
};

struct BondsBrokenInTension {
  double bonds_broken_in_tension = 0;
  static constexpr QuantityText text{"bonds_broken_in_tension", "1", "since they were made"};
  static constexpr auto member = &BondsBrokenInTension::bonds_broken_in_tension;
  static double measure(const MeasuredState& state) { return bonds_with(state, 1); }
};

struct BondsBrokenInShear {
  double bonds_broken_in_shear = 0;
  static constexpr QuantityText text{"bonds_broken_in_shear", "1", "since they were made"};
  static constexpr auto member = &BondsBrokenInShear::bonds_broken_in_shear;
  static double measure(const MeasuredState& state) { return bonds_with(state, 2); }
};

struct BondStress {
  Matrix3 bond_stress = Matrix3::Zero();
  static constexpr QuantityText text{"bond_stress_Pa", "Pa", "part of contact_stress_Pa that bonds bear"};
  static constexpr auto member = &BondStress::bond_stress;
  static Matrix3 measure(const MeasuredState& state) { return interaction_stress(state.network, Family::bonds); }
};

struct BondReleasedEnergy {
  double bond_released_energy = 0;
  static constexpr QuantityText text{"bond_released_energy_J", "J", "elastic energy that bonds gave up as they broke"};
  static constexpr auto member = &BondReleasedEnergy::bond_released_energy;
  static double measure(const MeasuredState& state) {
    return sum_over_bonds(state, [](auto law, const double* c) { return c[decltype(law)::released]; });
  }
};

// Water (rvelab/interaction/bridge.hpp).

struct Bridges {
  double bridges = 0;
  static constexpr QuantityText text{"bridges", "1", "of water between two grains"};
  static constexpr auto member = &Bridges::bridges;
  static double measure(const MeasuredState& state) { return double(state.acting(Family::water)); }
};

struct Saturation {
  double saturation = 0;
  static constexpr QuantityText text{"saturation", "1", "volume of the bridges over that of the pores"};
  static constexpr auto member = &Saturation::saturation;
  static double measure(const MeasuredState& state) { return state.water_volume() / pore_volume(state.network); }
};

struct BridgeStress {
  Matrix3 bridge_stress = Matrix3::Zero();
  static constexpr QuantityText text{"bridge_stress_Pa", "Pa", "part of contact_stress_Pa that bridges bear"};
  static constexpr auto member = &BridgeStress::bridge_stress;
  static Matrix3 measure(const MeasuredState& state) { return interaction_stress(state.network, Family::water); }
};

// Adhesion (rvelab/interaction: jkr.hpp, dmt.hpp).

struct AdhesivePairs {
  double adhesive_pairs = 0;
  static constexpr QuantityText text{"adhesive_pairs", "1", "of grains that attract one another"};
  static constexpr auto member = &AdhesivePairs::adhesive_pairs;
  static double measure(const MeasuredState& state) { return double(state.acting(Family::adhesion)); }
};

struct AdhesionStress {
  Matrix3 adhesion_stress = Matrix3::Zero();
  static constexpr QuantityText text{"adhesion_stress_Pa", "Pa", "part of contact_stress_Pa that adhesion bears"};
  static constexpr auto member = &AdhesionStress::adhesion_stress;
  static Matrix3 measure(const MeasuredState& state) { return interaction_stress(state.network, Family::adhesion); }
};

/// New ones come last: journals identify the requested quantities by their index in this list.
using Quantities = QuantityTable<  //
    VoidRatio,                     //
    CoordinationNumber,            //
    FabricAnisotropy,              //
    SlidingFraction,               //
    MechanicalVoidRatio,           //
    MechanicalCoordinationNumber,  //
    Fabric,                        //
    BranchFabric,                  //
    ContactStress,                 //
    ReynoldsStress,                //
    ElasticEnergy,                 //
    KineticEnergy,                 //
    OrientationFabric,             //
    ContactAnisotropy,             //
    NormalForceAnisotropy,         //
    TangentialForceAnisotropy,     //
    BranchAnisotropy,              //
    TangentialBranchAnisotropy,    //
    StressForceFabricRatio,        //
    FabricAngle,                   //
    StrongContacts,                //
    StrongDeviator,                //
    Bonds,                         //
    BondsBrokenInTension,          //
    BondsBrokenInShear,            //
    BondStress,                    //
    BondReleasedEnergy,            //
    Bridges,                       //
    Saturation,                    //
    BridgeStress,                  //
    AdhesivePairs,                 //
    AdhesionStress,                //
    BoundaryWork,                  //
    FrictionLoss,                  //
    RollingLoss,                   //
    DashpotLoss,                   //
    LocalDampingLoss,              //
    GlobalDampingLoss,             //
    LawLoss,                       //
    RemovedKinetic,                //
    ReleasedByBreaking,            //
    ReleasedByForming,             //
    GivenByStages,                 //
    TouchingNeighbours             //
    >;

inline constexpr auto quantity_rows = Quantities::rows();

/// Bit of a quantity in RecordedState::quantities.
template <class Quantity>
inline constexpr std::uint64_t asked = Quantities::bit_of<Quantity>();

/// Default of a protocol.
inline constexpr std::uint64_t usual_quantities = [] {
  std::uint64_t bits = 0;
  for (const QuantityRow& row : quantity_rows) bits |= row.text.usual ? row.bit : 0;
  return bits;
}();

/// Every quantity of the table.
inline constexpr std::uint64_t all_quantities = [] {
  std::uint64_t bits = 0;
  for (const QuantityRow& row : quantity_rows) bits |= row.bit;
  return bits;
}();

}  // namespace rvelab::records
