// Files of other kinds that are handed in by mistake, known by their first bytes.
#pragma once

#include <cstddef>
#include <string_view>

namespace rvelab::keys {

struct FileFormat {
  std::size_t at;          ///< where the magic stands
  std::string_view magic;  ///< its bytes
  const char* what;        ///< "a binary restart file of LAMMPS", behind "is "
  const char* remedy;      ///< how a text that rvelab reads is made of it
};

namespace formats {
constexpr const char *from_lammps = "write a text with write_data or write_dump in LAMMPS (lmp -restart2data R D)",
                     *from_yade = "load it in YADE and write the packing with export.text",
                     *from_vtk = "save it as CSV (ParaView: File, Save Data)",
                     *from_numpy = "write it with numpy.savetxt, with a header that names its columns",
                     *from_sheet = "save the sheet as CSV in the program that wrote it",
                     *from_hdf5 =
                         "of a specimen of rvelab make tables with `rvelab export`, of another file with its program";
}  // namespace formats

inline constexpr FileFormat file_formats[] = {
    {0, "LammpS RestartT", "a binary restart file of LAMMPS", formats::from_lammps},
    {8, "DUMPATOM", "a binary dump of LAMMPS", formats::from_lammps},
    {8, "DUMPCUSTOM", "a binary dump of LAMMPS", formats::from_lammps},
    {0, {"\x89HDF\r\n\x1a\n", 8}, "an HDF5 file", formats::from_hdf5},
    {0, {"CDF\x01", 4}, "a NetCDF file", "write its columns as text (ncdump shows them)"},
    {0, {"CDF\x02", 4}, "a NetCDF file", "write its columns as text (ncdump shows them)"},
    {0, "\x1f\x8b", "packed by gzip", "unpack it with gunzip"},
    {0, {"\x28\xb5\x2f\xfd", 4}, "packed by zstd", "unpack it with unzstd"},
    {0, {"\xfd\x37zXZ\0", 6}, "packed by xz", "unpack it with unxz"},
    {0, "BZh", "packed by bzip2", "unpack it with bunzip2; of a save of YADE write the packing with export.text"},
    {0, {"PK\x03\x04", 4}, "packed by zip", "unpack it with unzip; save a workbook as CSV, an .npz by numpy"},
    {0, {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", 8}, "a workbook of Excel (.xls)", formats::from_sheet},
    {0, "\x93NUMPY", "an array of numpy (.npy)", formats::from_numpy},
    {0, {"\x80\x04\x95", 3}, "a pickle of Python", formats::from_numpy},
    {0, {"\x80\x05\x95", 3}, "a pickle of Python", formats::from_numpy},
    {0, "MATLAB 5.0 MAT-file", "a MAT-file of MATLAB", "write it with writetable in MATLAB"},
    {0, "PAR1", "a Parquet file", formats::from_sheet},
    {0, "SQLite format 3", "a database of SQLite", formats::from_sheet},
    {0, "# vtk DataFile Version", "a VTK file", formats::from_vtk},
    {4, "serialization::archive", "a save of YADE", formats::from_yade},
    {8, "serialization::archive", "a save of YADE", formats::from_yade},
    {3, "serialization::archive", "a save of YADE", formats::from_yade},
    {0, "%PDF-", "a PDF", "save the table as CSV in the program that made it"},
};

/// What a file of these bytes is; nullptr: of no format in the list.
inline const FileFormat* format_of(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  static constexpr FileFormat in_zip[] = {
      {0, "opendocument", "a sheet of LibreOffice (.ods)", formats::from_sheet},
      {0, "[Content_Types].xml", "a workbook of Excel (.xlsx)", formats::from_sheet},
      {0, "xl/", "a workbook of Excel (.xlsx)", formats::from_sheet},
  };
  if (head.starts_with("PK\x03\x04"))
    for (const FileFormat& format : in_zip)
      if (head.find(format.magic) != std::string_view::npos) return &format;
  for (const FileFormat& format : file_formats)
    if (bytes.size() > format.at && bytes.substr(format.at).starts_with(format.magic)) return &format;
  static constexpr FileFormat in_xml[] = {
      {0, "<!DOCTYPE boost_serialization>", "a save of YADE", formats::from_yade},
      {0, "<VTKFile", "a VTK file", formats::from_vtk},
  };
  if (bytes.starts_with("<?xml") || bytes.starts_with("<VTKFile"))
    for (const FileFormat& format : in_xml)
      if (head.find(format.magic) != std::string_view::npos) return &format;
  return nullptr;
}

}  // namespace rvelab::keys
