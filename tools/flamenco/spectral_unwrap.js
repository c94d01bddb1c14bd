// SPDX-License-Identifier: GPL-3.0-or-later
// Job type for Flamenco 3: copy it into the folder `scripts` beside Flamenco Manager; see docs/batch.md.

const JOB_TYPE = {
    label: "Spectral Unwrap",
    description: "Unwrap a folder of assets, a part of them per task, and write an overview",
    settings: [
        { key: "inputs", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Folder of the assets, on a disk that all workers share" },
        { key: "out", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Folder of the results, on a disk that all workers share" },
        { key: "python", type: "string", default: "python3", visible: "submission",
          description: "Python with spectral_conformal[batch], by the same path on all workers" },
        { key: "parts", type: "int32", default: 16, visible: "submission",
          description: "Number of tasks" },
        { key: "options", type: "string", default: "", visible: "submission",
          description: "Further options of the batch, such as: --seams sharp --seconds 600" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const options = settings.options ? settings.options.split(" ").filter((word) => word.length > 0) : [];
    const parts = Math.max(1, settings.parts);

    const overview = authorTask("overview", settings, ["--overview", ...options]);
    for (let part = 1; part <= parts; part++) {
        // A task that Flamenco gives out again goes on where the first try was.
        const task = authorTask(`unwrap-${part}`, settings, ["--part", `${part}/${parts}`, "--resume", ...options]);
        job.addTask(task);
        overview.addDependency(task);
    }
    job.addTask(overview);
}

function authorTask(name, settings, further) {
    const task = author.Task(name, "misc");
    task.addCommand(author.Command("exec", {
        exe: settings.python,
        args: ["-m", "spectral_conformal", "batch", settings.inputs, "--out", settings.out, ...further],
    }));
    return task;
}
