#include "tools/mpm/output/frames.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "rvelab/io/publish.hpp"

namespace mpm {

std::string frame_name(const std::string& what, std::size_t frame) {
  char name[32];
  std::snprintf(name, sizeof name, "_%04zu.h5", frame);
  return what + name;
}

Frame::Frame(const std::string& what, std::size_t count, const std::string& folder, const std::vector<double>& times)
    : what_(what),
      folder_(folder),
      count_(count),
      times_(times),
      file_(rvelab::io::Hdf5File::in_memory(
          (std::filesystem::path(folder) / frame_name(what, times.size() - 1)).string())) {
  add("time_s", std::span(&times.back(), 1), {1});
}

void Frame::add(const std::string& name, std::span<const double> values, const rvelab::io::Shape64& shape) {
  file_.write("/" + name, values, shape);
}

void Frame::publish() const {
  rvelab::io::publish(file_.path(), file_, rvelab::io::Sync::later);
  const auto n = std::to_string(count_);
  std::ostringstream file;
  file << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
       << "<Grid Name=\"" << what_ << "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times_.size(); ++k) {
    const auto item = [&](const std::string& name, const std::string& type) {
      const auto width = type == "Scalar" ? "" : " " + std::to_string(widths(type));
      return "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" + n + width + "\">" +
             frame_name(what_, k) + ":/" + name + "</DataItem>";
    };
    file << "<Grid Name=\"" << what_ << "\"><Time Value=\"" << times_[k]
         << "\"/>\n<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" << n
         << "\"/>\n<Geometry GeometryType=\"XYZ\">" << item("position_m", "Vector") << "</Geometry>\n";
    for (const auto& [name, type] : shown_) {
      file << "<Attribute Name=\"" << name << "\" AttributeType=\"" << type << "\" Center=\"Node\">" << item(name, type)
           << "</Attribute>\n";
    }
    file << "</Grid>\n";
  }
  file << "</Grid>\n</Domain></Xdmf>\n";
  rvelab::io::publish_text((std::filesystem::path(folder_) / (what_ + ".xdmf")).string(), file.str(),
                           rvelab::io::Sync::later);
}

}  // namespace mpm
