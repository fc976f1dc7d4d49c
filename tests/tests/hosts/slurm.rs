//! Test of `eomgen sweep --engine slurm` on a cluster of two nodes on this machine. One node is killed with its jobs
//! during the sweep. The merged table must be byte-identical to the table of a single process. Skipped with a message
//! if Slurm is not installed.
#![cfg(target_os = "linux")]

use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use eomgen_tests::program::{self, text};

const OSCILLATOR: &str = r#"
[model]
name  = "oscillator"
[parameters]
m     = { value = 1, unit = "kg" }
c     = { value = 0.5, unit = "N s/m" }
k     = { value = 4, unit = "N/m" }
F     = { value = 3, unit = "N" }
omega = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
drive = { on = "x", value = "F*sin(omega*t)" }
"#;

/// Options of a sweep that takes some seconds, long enough for a kill between the first and the last point.
const SWEEP: [&str; 10] = [
    "--vary",
    "c=0.4:1:10",
    "--vary",
    "omega=1:3:30",
    "--measure",
    "poincare",
    "--transient",
    "900000",
    "--periods",
    "8",
];

const LIMIT: Duration = Duration::from_secs(180);

/// Cluster of two nodes with their controller and the authentication daemon. Dropping it stops all processes.
struct Cluster {
    folder: tempfile::TempDir,
    daemons: Vec<Child>,
}

impl Cluster {
    fn start() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut cluster = Self {
            folder,
            daemons: Vec::new(),
        };
        fs::create_dir(cluster.path_to("state")).expect("a folder");
        fs::write(cluster.path_to("key"), [7; 1024]).expect("a key");
        make_private(&cluster.path_to("key"));
        fs::write(cluster.path_to("slurm.conf"), cluster.configuration()).expect("a configuration");
        let names = [
            ("key-file", "key"),
            ("socket", "socket"),
            ("pid-file", "munge.pid"),
            ("log-file", "munge.log"),
            ("seed-file", "seed"),
        ];
        let munge =
            names.map(|(option, name)| format!("--{option}={}", cluster.path_to(name).display()));
        cluster.spawn("munged", &["--foreground", "--force"], &munge, "none");
        cluster.wait("munged", |cluster| cluster.path_to("socket").exists());
        cluster.spawn("slurmctld", &["-D"], &[], "none");
        for node in ["n1", "n2"] {
            cluster.spawn("slurmd", &["-D", "-N", node], &[], node);
        }
        cluster.wait("both nodes", |cluster| {
            cluster.run_client("sinfo", &["-h", "-o", "%T %D"]).trim() == "idle 2"
        });
        cluster
    }

    fn path_to(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configuration(&self) -> String {
        let at = |name: &str| self.path_to(name).display().to_string();
        let [controller, first, second] = free_ports();
        let user = text(
            &Command::new("id")
                .arg("-un")
                .output()
                .expect("a name")
                .stdout,
        );
        format!(
            "ClusterName=test\nSlurmctldHost=localhost\nSlurmctldPort={controller}\n\
             AuthType=auth/munge\nAuthInfo=socket={}\nCredType=cred/munge\n\
             SlurmUser={user}SlurmdUser={user}StateSaveLocation={}\nSlurmdSpoolDir={}\n\
             SlurmctldPidFile={}\nSlurmdPidFile={}\nSlurmctldLogFile={}\nSlurmdLogFile={}\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n\
             JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
             MpiDefault=none\nSlurmdTimeout=5\nSchedulerParameters=sched_interval=1\n\
             NodeName=n1 NodeHostname=localhost Port={first} CPUs=1\n\
             NodeName=n2 NodeHostname=localhost Port={second} CPUs=1\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n",
            at("socket"),
            at("state"),
            at("spool_%n"),
            at("controller.pid"),
            at("%n.pid"),
            at("controller.log"),
            at("%n.log"),
        )
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.path_to("slurm.conf"));
        command
    }

    fn spawn(&mut self, program: &str, options: &[&str], more: &[String], node: &str) {
        let mut command = self.command(program);
        command.args(options).args(more).env(NODE, node);
        let daemon = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        self.daemons.push(daemon.expect("a daemon of Slurm"));
    }

    fn run_client(&self, program: &str, arguments: &[&str]) -> String {
        let output = self.command(program).args(arguments).output();
        text(&output.expect("a command of Slurm").stdout)
    }

    fn wait(&self, what: &str, mut is_so: impl FnMut(&Self) -> bool) {
        let begin = Instant::now();
        while !is_so(self) {
            assert!(
                begin.elapsed() < LIMIT,
                "waited for {what}: {}",
                self.logs()
            );
            sleep(Duration::from_millis(50));
        }
    }

    fn logs(&self) -> String {
        let read = |name| fs::read_to_string(self.path_to(name)).unwrap_or_default();
        ["controller.log", "n1.log", "n2.log"]
            .map(read)
            .join("\n--\n")
    }

    /// Returns the processes of this cluster that have `variable` in their environment.
    fn processes(&self, variable: &str) -> Vec<String> {
        let configuration = format!("SLURM_CONF={}", self.path_to("slurm.conf").display());
        let mut found = Vec::new();
        for entry in fs::read_dir("/proc").expect("/proc") {
            let path = entry.expect("an entry").path();
            let environment = fs::read(path.join("environ")).unwrap_or_default();
            let environment = String::from_utf8_lossy(&environment).into_owned();
            let has = |wanted: &str| environment.split('\0').any(|one| one == wanted);
            if has(&configuration) && has(variable) {
                let number = path.file_name().expect("a number");
                found.push(number.to_string_lossy().into_owned());
            }
        }
        found
    }

    /// Kills a node as a power failure would: first the supervisors of the jobs, then the jobs. Returns the number of
    /// job processes.
    fn kill(&self, node: &str) -> usize {
        let jobs = self.processes(&format!("SLURMD_NODENAME={node}"));
        let watching = jobs.iter().filter_map(|job| job_supervisor(job)).collect();
        let daemon = self.processes(&format!("{NODE}={node}"));
        let all = [daemon, watching, jobs.clone()].concat();
        // The status is ignored, because processes may have ended already.
        let mut command = Command::new("kill");
        command
            .arg("-9")
            .args(all)
            .stderr(Stdio::null())
            .status()
            .ok();
        jobs.len()
    }
}

/// Returns the Slurm process that supervises a job: the parent of its script.
fn job_supervisor(job: &str) -> Option<String> {
    let status = fs::read_to_string(format!("/proc/{job}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
    let parent = parent.trim().to_owned();
    let name = fs::read_to_string(format!("/proc/{parent}/comm")).ok()?;
    name.starts_with("slurmstepd").then_some(parent)
}

/// Environment variable that identifies a node's daemons. Jobs of the node are identified by a variable of Slurm.
const NODE: &str = "EOMGEN_TEST_NODE";

impl Drop for Cluster {
    fn drop(&mut self) {
        for node in ["n1", "n2", "none"] {
            self.kill(node);
        }
        for daemon in &mut self.daemons {
            daemon.wait().ok();
        }
    }
}

fn make_private(path: &Path) {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o600)).expect("permissions");
}

fn free_ports() -> [u16; 3] {
    let listen = |_| TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    let listening = [0, 1, 2].map(listen);
    listening.map(|socket| socket.local_addr().expect("an address").port())
}

fn has_slurm() -> bool {
    let version = |program: &str| Command::new(program).arg("-V").output().is_ok();
    ["slurmctld", "slurmd", "sbatch", "munged"]
        .into_iter()
        .all(version)
}

fn parts(folder: &Path) -> usize {
    let Ok(entries) = fs::read_dir(folder.join("parts")) else {
        return 0;
    };
    entries
        .filter(|entry| {
            entry
                .as_ref()
                .is_ok_and(|e| e.path().extension().is_some_and(|x| x == "part"))
        })
        .count()
}

#[test]
fn sweep_completes_after_a_node_is_killed() {
    if !has_slurm() {
        skips::skip("no sweep was run on Slurm (Debian: apt-get install slurm-wlm munge)");
        return;
    }
    let cluster = Cluster::start();
    // The path needs quoting in a shell.
    let place = cluster.path_to("it's a $place");
    fs::create_dir(&place).expect("a folder");
    fs::write(place.join("oscillator.toml"), OSCILLATOR).expect("a specification");
    let program = program::path().display().to_string();
    let sweep = |out: &str, more: &[&str]| {
        let output = cluster
            .command(&program)
            .args(["sweep", "oscillator.toml", "--out", out])
            .args(SWEEP)
            .args(more)
            .current_dir(&place)
            .output()
            .expect("the program");
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    sweep("alone", &[]);
    let said = sweep("spread", &["--engine", "slurm", "--shards", "6"]);
    assert!(said.contains("with 6 shards"), "{said}");
    let (alone, spread) = (place.join("alone"), place.join("spread"));
    cluster.wait("parts", |_| parts(&spread) >= 4);
    assert!(cluster.kill("n2") > 0, "nothing ran on the node");
    assert!(parts(&spread) < parts(&alone), "killed too late");
    cluster.wait("the merge", |cluster| {
        // Slurm would delay the tasks of a failed node by two minutes, so they are released.
        for line in cluster
            .run_client("squeue", &["-h", "-r", "-t", "PD", "-o", "%i %r"])
            .lines()
        {
            if let Some(job) = line.strip_suffix(" BeginTime") {
                let now = format!("JobId={job}");
                cluster.run_client("scontrol", &["update", &now, "StartTime=now"]);
            }
        }
        cluster.run_client("squeue", &["-h"]).trim().is_empty()
    });
    let log = fs::read_to_string(spread.join("slurm/merge.log")).unwrap_or_default();
    for name in ["sweep.json", "sweep.parquet", "map_poincare.png"] {
        let read = |folder: &Path| fs::read(folder.join(name)).unwrap_or_default();
        assert!(
            !read(&alone).is_empty() && read(&alone) == read(&spread),
            "{name}: {log}\n{}",
            cluster.logs()
        );
    }
}
