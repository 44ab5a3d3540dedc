//! Checks the links of the manual and of every README: each target must be an existing file, and each anchor
//! a heading of it.
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Collects the Markdown files below `folder`, without build output and hidden folders.
fn markdown(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            if !name.starts_with('.') && name != "target" && name != "runs" {
                markdown(&path, found);
            }
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
}

/// Returns the lines of a Markdown text outside of fenced and indented code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut fenced = false;
    text.lines().filter(move |line| {
        if line.starts_with("```") {
            fenced = !fenced;
        }
        !fenced && !line.starts_with("    ")
    })
}

/// Returns the targets of the links and pictures in a Markdown text.
fn targets(text: &str) -> Vec<String> {
    let ends = prose(text).flat_map(|line| line.split("](").skip(1));
    ends.filter_map(|rest| rest.split_once(')').map(|(target, _)| target.to_owned()))
        .collect()
}

/// Returns the anchor of a Markdown heading as Git forges make it: lower case, hyphens for spaces, no
/// punctuation.
fn anchor(heading: &str) -> String {
    let kept = heading
        .trim_start_matches('#')
        .trim()
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
        .collect::<String>();
    kept.replace(' ', "-")
}

/// Returns the reason why a link from `file` leads nowhere; `None` if its target exists.
fn broken(file: &Path, text: &str, target: &str) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (path, fragment) = target.split_once('#').unwrap_or((target, ""));
    let place = file.parent().expect("a file has a folder").join(path);
    let whole = if path.is_empty() {
        text.to_owned()
    } else if place.exists() {
        fs::read_to_string(&place).unwrap_or_default()
    } else {
        return Some(format!("{target}: no such file"));
    };
    let known = fragment.is_empty()
        || prose(&whole).any(|line| line.starts_with('#') && anchor(line) == fragment);
    (!known).then(|| format!("{target}: no such heading"))
}

#[test]
fn every_link_of_the_manual_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    markdown(&root, &mut files);
    let (mut seen, mut wrong) = (0, Vec::new());
    for file in &files {
        let text = fs::read_to_string(file).expect("readable");
        for target in targets(&text) {
            seen += 1;
            let place = file.strip_prefix(&root).expect("inside").display();
            wrong.extend(broken(file, &text, &target).map(|why| format!("{place}: {why}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 60, "{seen} links are not all of them");
}

#[test]
fn every_page_of_the_manual_is_reached_from_the_readme() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let readme = fs::read_to_string(root.join("README.md")).expect("the README");
    let linked = targets(&readme);
    for entry in root.join("docs").read_dir().expect("the manual") {
        let name = entry.expect("an entry").file_name();
        let target = format!("docs/{}", name.to_string_lossy());
        assert!(linked.contains(&target), "README.md does not link {target}");
    }
    assert!(readme.lines().count() <= 150, "the README is one page");
}

#[test]
fn a_link_without_a_target_is_found() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = "# One two\n[a](#one-two) [b](#three) [c](main.rs) [d](missing.rs)\n    [e](code)\n";
    let wrong: Vec<bool> = targets(text)
        .iter()
        .map(|target| broken(&file, text, target).is_some())
        .collect();
    assert_eq!(wrong, [false, true, false, true]);
}
