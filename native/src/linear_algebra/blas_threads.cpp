#include "linear_algebra/blas_threads.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <mutex>
#include <shared_mutex>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

// LAPACK, Fortran linkage. Its address tells which library serves CHOLMOD; on Windows without dllimport it would be
// that of a stub in our own module.
#ifdef _WIN32
extern "C" __declspec(dllimport) void zpotrf_(const char*, const int*, void*, const int*, int*);
#else
extern "C" void zpotrf_(const char*, const int*, void*, const int*, int*);
#endif

namespace spectral_conformal {
namespace {

/// The loaded library that defines zpotrf_. It stays loaded: CHOLMOD is linked to it.
#ifdef _WIN32
class BlasFile {
 public:
  BlasFile() {
    constexpr DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    if (GetModuleHandleExA(flags, reinterpret_cast<LPCSTR>(&zpotrf_), &handle_) == 0) handle_ = nullptr;
  }
  std::string name() const {
    char name[MAX_PATH];
    return handle_ == nullptr ? "" : std::string(name, GetModuleFileNameA(handle_, name, MAX_PATH));
  }
  void* find(const char* symbol) const {
    return handle_ == nullptr ? nullptr : reinterpret_cast<void*>(GetProcAddress(handle_, symbol));
  }

 private:
  HMODULE handle_ = nullptr;
};
#else
class BlasFile {
 public:
  BlasFile() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&zpotrf_), &info) == 0 || info.dli_fname == nullptr) return;
    name_ = info.dli_fname;
    handle_ = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  }
  ~BlasFile() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  BlasFile(const BlasFile&) = delete;
  BlasFile& operator=(const BlasFile&) = delete;
  std::string name() const { return name_; }
  void* find(const char* symbol) const { return handle_ == nullptr ? nullptr : dlsym(handle_, symbol); }

 private:
  void* handle_ = nullptr;
  std::string name_;
};
#endif

/// OpenBLAS's own functions; null in any other BLAS.
struct OpenBlas {
  int (*get_parallel)() = nullptr;
  int (*get_num_threads)() = nullptr;
  void (*set_num_threads)(int) = nullptr;
  const char* (*get_config)() = nullptr;

  explicit OpenBlas(const BlasFile& file) {
    find(file, "openblas_get_parallel", get_parallel);
    find(file, "openblas_get_num_threads", get_num_threads);
    find(file, "openblas_set_num_threads", set_num_threads);
    find(file, "openblas_get_config", get_config);
  }
  bool has_threads() const { return get_num_threads != nullptr && set_num_threads != nullptr; }

 private:
  template <class Function>
  static void find(const BlasFile& file, const std::string& name, Function& function) {
    void* symbol = file.find(name.c_str());
    if (symbol == nullptr) symbol = file.find(("scipy_" + name).c_str());  // as in the wheels of scipy-openblas32
    function = reinterpret_cast<Function>(symbol);
  }
};

const OpenBlas& open_blas() {
  static const OpenBlas functions{BlasFile()};
  return functions;
}

/// Who holds the process-wide setting: as much one for the process as the setting itself.
struct Holders {
  std::shared_mutex gate;  ///< shared by holders of one thread
  std::mutex counting;     ///< for what follows
  int count = 0;
  int before = 0;  ///< the setting that the first of them found
  int fixed = 0;   ///< what the first of them set
};

Holders& holders() {
  static Holders of_process;
  return of_process;
}

/// Whether OpenBLAS keeps one setting for all threads of the process, and may be called by several of them at once.
/// Built with OpenMP (2), the thread that sets the number has one of its own; built without threads (0), two calls at
/// once share their buffers.
bool serves_many() {
  constexpr int with_its_own_threads = 1;
  return open_blas().get_parallel == nullptr || open_blas().get_parallel() == with_its_own_threads;
}

}  // namespace

std::optional<int> blas_thread_setting() {
  if (!open_blas().has_threads()) return std::nullopt;
  return open_blas().get_num_threads();
}

void set_blas_thread_setting(int threads) {
  if (open_blas().has_threads()) open_blas().set_num_threads(threads);
}

BlasThreads::BlasThreads(Count count) : is_alone_(count == Count::two || !serves_many()) {
  if (!open_blas().has_threads()) return;
  Holders& all = holders();
  if (is_alone_) {
    all.gate.lock();
  } else {
    all.gate.lock_shared();
  }
  const std::lock_guard<std::mutex> lock(all.counting);
  if (all.count++ > 0) return;
  all.before = open_blas().get_num_threads();
  all.fixed = count == Count::two ? 2 : 1;
  if (all.before != all.fixed) open_blas().set_num_threads(all.fixed);
}

BlasThreads::~BlasThreads() {
  if (!open_blas().has_threads()) return;
  Holders& all = holders();
  {
    const std::lock_guard<std::mutex> lock(all.counting);
    const bool is_ours = --all.count == 0 && open_blas().get_num_threads() == all.fixed;
    if (is_ours && all.before != all.fixed) open_blas().set_num_threads(all.before);
  }
  if (is_alone_) {
    all.gate.unlock();
  } else {
    all.gate.unlock_shared();
  }
}

std::string blas_library() {
  const std::string file = BlasFile().name();
  return open_blas().get_config == nullptr ? file : file + " (" + open_blas().get_config() + ")";
}

}  // namespace spectral_conformal

#else

namespace spectral_conformal {

std::optional<int> blas_thread_setting() { return std::nullopt; }
void set_blas_thread_setting(int) {}
BlasThreads::BlasThreads(Count) : is_alone_(false) {}
BlasThreads::~BlasThreads() = default;
std::string blas_library() { return ""; }

}  // namespace spectral_conformal

#endif
