// Writing a whole file so that a reader, or a kill at any moment, finds the old one or the new one; and the one rule on
// what may be written over.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace rvelab::io {

/// The file that a path means: symbolic links are followed, to a file that is not there yet too.
std::string followed(const std::string& path);

/// Name of the journal of a record file: beside the file itself, where `record_file` is a link to it.
inline std::string journal_of(const std::string& record_file) { return followed(record_file) + ".journal"; }

/// Refuses an output (InputError) before any work for it is done: one that is among the inputs or beside which an input
/// has the name that rvelab writes to meanwhile, one that is no regular file (a folder, a device, a pipe), and, without
/// `force`, one that is there already. `otherwise`: what else than a new name and --force is allowed, ", or ...".
void expect_output(const std::string& path, bool force, const std::vector<std::string>& inputs,
                   const std::string& otherwise = "");

/// The same without the last part: what is there is the caller's to judge.
void expect_place(const std::string& path, const std::vector<std::string>& inputs = {});

/// Whether a published file survives a power loss. Outputs that a run makes again from its last checkpoint need not:
/// two syncs of a file take some milliseconds, more than a small one takes to write.
enum class Sync { now, later };

/// Writes the parts one after the other as path.tmp, syncs it to disc and renames it to path. A second program that
/// writes the same name waits for the first. InputError if the folder does not exist or may not be written, or if path
/// is no regular file; Error if the writing fails (path.tmp is removed, path is as it was).
void publish_bytes(const std::string& path, std::initializer_list<std::span<const std::byte>> parts,
                   Sync sync = Sync::now);

/// The shortest decimal that reads back as the same double (up to 17 digits).
std::string exact(double value);

/// Writes path.tmp and renames it to path. InputError if the place cannot be written to, Error if the writing fails.
void publish_text(const std::string& path, const std::string& text, Sync sync = Sync::now);

}  // namespace rvelab::io
