// SPDX-FileCopyrightText: 2026 Body Moments contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A job type of Flamenco: each task measures a part of a list, and the last one joins their results, in a folder of the
// job's name. Files are opened by child processes that the command starts, never by the Blender of the task: a file that
// kills Blender is a record.
const JOB_TYPE = {
    label: "Body Moments",
    description: "Mass properties of the files of a list",
    settings: [
        { key: "manifest", type: "string", subtype: "file_path", required: true,
          description: "What `manifest --parts N` has written, on shared storage" },
        { key: "parts", type: "int32", required: true, propargs: { min: 1 },
          description: "N: choose parts of one to five minutes of work" },
        { key: "addon", type: "string", subtype: "dir_path", required: true,
          description: "The folder of the add-on, on shared storage" },
        { key: "folder", type: "string", subtype: "dir_path", required: true,
          description: "Where results go, on shared storage" },
        { key: "timeout", type: "int32", default: 600, propargs: { min: 1 },
          description: "Seconds that one file may take; Flamenco itself has no limit" },
        { key: "memory", type: "int32", default: 3000, propargs: { min: 1 },
          description: "Megabytes that one file may take" },
        { key: "options", type: "string", default: "", description: "Further options of `measure`" },
        { key: "python", type: "string", default: "python3", description: "Any Python 3.11 or newer on the workers" },
        { key: "blender", type: "string", default: "blender", description: "The Blender that measures, on the workers" },
    ],
};
const MAKE_FOLDER = "import os, sys; os.makedirs(sys.argv[1], exist_ok=True)";

function compileJob(job) {
    const settings = withDefaults(job.settings);
    const results = path.join(settings.folder, job.name.replace(/[^\w.-]+/g, "_"));
    const script = path.join(settings.addon, "operators", "batch.py");
    const merge = author.Task("merge", "misc");
    const parts = [];
    for (let number = 1; number <= settings.parts; number++) {
        const part = path.join(results, "part-" + number + ".jsonl");
        parts.push(part);
        const task = author.Task("measure " + number, "misc");
        task.addCommand(author.Command("exec", { exe: settings.python, args: ["-c", MAKE_FOLDER, results] }));
        task.addCommand(author.Command("exec", { exe: settings.python, args: measure(settings, script, number, part) }));
        merge.addDependency(task);
        job.addTask(task);
    }
    const words = [script, "merge", "--force", "--manifest", settings.manifest, "--output", path.join(results, "all.jsonl")];
    merge.addCommand(author.Command("exec", { exe: settings.python, args: words.concat(parts) }));
    job.addTask(merge);
}

// What is submitted by the web interface's API has no defaults of the job type.
function withDefaults(given) {
    const settings = {};
    for (const setting of JOB_TYPE.settings) {
        const value = given[setting.key];
        settings[setting.key] = value === undefined || value === null ? setting.default : value;
        if (settings[setting.key] === undefined) throw "The setting " + setting.key + " is missing.";
    }
    if (settings.parts < 1) throw "The setting parts is below 1.";
    return settings;
}

// A file that cannot be measured has its record, and its part still counts as measured: --errors-exit-0.
function measure(settings, script, number, part) {
    const words = [script, "measure", "--blender", settings.blender, "--manifest", settings.manifest,
        "--part", String(number), "--timeout", String(settings.timeout), "--memory-mb", String(settings.memory),
        "--resume", "--errors-exit-0", "--format", "jsonl", "--output", part];
    return words.concat(shellSplit(settings.options));
}
