// SPDX-FileCopyrightText: 2026 Body Moments contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A job type of Flamenco: each task measures a range of a list, and the last one joins their results. Files are opened
// by child processes that the command starts, never by the Blender of the task: a file that kills Blender is a record.
const JOB_TYPE = {
    label: "Body Moments",
    description: "Mass properties of the files of a list",
    settings: [
        { key: "manifest", type: "string", subtype: "file_path", required: true,
          description: "What `manifest` has written, on shared storage" },
        { key: "script", type: "string", subtype: "file_path", required: true,
          description: "operators/batch.py of the add-on, on shared storage" },
        { key: "folder", type: "string", subtype: "dir_path", required: true,
          description: "Where results go, on shared storage" },
        { key: "count", type: "int32", required: true, description: "How many files the list has" },
        { key: "size", type: "int32", default: 100, propargs: { min: 1 },
          description: "Files of a task: one to five minutes of work" },
        { key: "timeout", type: "int32", default: 600, propargs: { min: 1 },
          description: "Seconds that one file may take; Flamenco itself has no limit" },
        { key: "options", type: "string", default: "", description: "Further options of `measure`" },
        { key: "python", type: "string", default: "python3", description: "Any Python 3.11 or newer on the workers" },
        { key: "blender", type: "string", default: "blender", description: "The Blender that measures, on the workers" },
    ],
};

function compileJob(job) {
    const settings = withDefaults(job.settings);
    const merge = author.Task("merge", "misc");
    const parts = [];
    for (let begin = 0; begin < settings.count; begin += settings.size) {
        const part = path.join(settings.folder, "part-" + begin + ".jsonl");
        parts.push(part);
        const task = author.Task("measure " + begin, "misc");
        task.addCommand(measure(settings, begin, part));
        merge.addDependency(task);
        job.addTask(task);
    }
    const words = [settings.script, "merge", "--force", "--output", path.join(settings.folder, "all.jsonl")];
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
    if (settings.size < 1) throw "The setting size is below 1.";
    return settings;
}

// A file that cannot be measured has its record, and its range still counts as measured: --errors-exit-0.
function measure(settings, begin, part) {
    const words = [settings.script, "measure", "--blender", settings.blender, "--manifest", settings.manifest,
        "--range", begin + ":" + (begin + settings.size), "--timeout", String(settings.timeout),
        "--resume", "--errors-exit-0", "--format", "jsonl", "--output", part];
    return author.Command("exec", { exe: settings.python, args: words.concat(shellSplit(settings.options)) });
}
