function gateways(made, references)
% Gateways for MATLAB and Octave compute what redysim and ReDySim compute, take many states at once, and report arguments that
% do not fit. `made` has a folder of each compiled gateway, `references` is the folder of the references.
models = {'kr5', 'gripper', 'pendulum', 'fourbar', 'machine', 'given', 'worn'};
for i = 1:numel(models)
    addpath(fullfile(made, models{i}));
    % All functions against the run-time path, within bounds of rounding errors.
    feval([models{i} '_check']);
    assert(~isempty(strfind(help(models{i}), [models{i} '(''neutral'''])));
end

% ReDySim's own inverse dynamics along its trajectory, in one call; both differ by roundings of the largest torques.
rows = dlmread(fullfile(references, 'golden_octave_ID_KUKA_Robot.csv'), ',', 1, 0)';
[q, v, a, tau] = deal(rows(2:7, :), rows(8:13, :), rows(14:19, :), rows(20:25, :));
found = kr5('inverse_dynamics', q, v, a);
assert(size(found), size(tau));
assert(max(abs(found(:) - tau(:))) < 1e-12 * max(abs(tau(:))));

% A state in each column: the same bits as state by state, whatever the shape of the result.
k = 5;
q = q(:, 1:200:1000) + (1:6)';
v = v(:, 1:200:1000) + (6:-1:1)';
one = @(name) @(i) kr5(name, q(:, i), v(:, i));
c = kr5('coriolis_matrix', q, v);
e = kr5('energy', q, v);
links = kr5('link_kinematics', q, v);
power = kr5('dissipated_power', q, v);
assert({size(c), size(e), size(e.kinetic), size(links), size(links(3).rotation), size(links(3).origin), size(power)}, ...
    {[6 6 k], [1 1], [1 k], [6 1], [3 3 k], [3 k], [1 k]});
for i = 1:k
    assert(isequal(c(:, :, i), one('coriolis_matrix')(i)));
    assert(isequal(struct('kinetic', e.kinetic(i), 'potential', e.potential(i)), one('energy')(i)));
    alone = one('link_kinematics')(i);
    assert(isequal(links(5).rotation(:, :, i), alone(5).rotation) && isequal(links(5).com(:, i), alone(5).com));
end
% An argument with one state is that of all; rows are vectors.
assert(isequal(kr5('bias_forces', q, v(:, 1)'), kr5('bias_forces', q, repmat(v(:, 1), 1, k))));
assert(isequal(size(kr5('gravity_forces', zeros(6, 0))), [6 0]));
% Of one coordinate, a row has several states.
assert(isequal(size(pendulum('gravity_forces', [0.1 0.2 0.3])), [1 3]));
% A wrench in each column, a state on each page.
wrenches = reshape(1:60, 6, 5, 2);
q = [0.1 0.2; 0.3 0.4; 0.5 0.6; 0.7 0.8; 0.9 1.0];
both = machine('frame_forces', q, wrenches);
assert(isequal(both(:, 2), machine('frame_forces', q(:, 2), wrenches(:, :, 2))));
% Jᵀ w of the same frames, to roundings.
jacobians = machine('frame_jacobians', q(:, 2));
expected = zeros(5, 1);
for i = 1:5
    expected += [jacobians(i).linear; jacobians(i).angular]' * wrenches(:, i, 2);
end
assert(both(:, 2), expected, 1e-13);

% Names and parameters; those of the model are the default, and gravity is linear in them.
model = given('model');
assert(model.parameter_names{4}, 'link3.mass');
assert(model.parameter_units{4}, 'kg');
assert(kr5('model').velocity_units{1}, 'rad/s');
q = [0.3 -0.8 1.1 2];
p = model.parameters;
assert(isequal(given('gravity_forces', q), given('gravity_forces', q, p)));
p(1:3) *= 2;
assert(given('gravity_forces', q, p), 2 * given('gravity_forces', q), 1e-14);

p(4) = -1;
reports('redysim:parameters', 'link3.mass must be a finite number that is not negative', @() given('gravity_forces', q, p));
reports('redysim:shape', 'parameters of gravity_forces must be', @() given('gravity_forces', q, p(1:3)));
reports('redysim:value', 'number 2 of state 1 is NaN', @() given('gravity_forces', q, [p(1); NaN; p(3:end)]));
reports('redysim:arguments', 'takes 1 arguments and may take parameters, not 0', @() given('gravity_forces'));
reports('redysim:function', 'the first argument must be the name of a function, such as ''inverse_dynamics''', @() kr5());
reports('redysim:function', 'the first argument must be the name', @() kr5(3));
reports('redysim:function', 'there is no function ''dynamics''', @() kr5('dynamics', 1));
reports('redysim:function', 'there is no function', @() kr5(repmat('energy', 1, 40), 1));
reports('redysim:arguments', 'energy takes 2 arguments, not 1', @() pendulum('energy', 1));
reports('redysim:arguments', 'energy takes 2 arguments, not 3', @() pendulum('energy', 1, 2, 3));
reports('redysim:arguments', 'energy gives one result, not 2', @two_results);
reports('redysim:shape', 'q of energy must be 6 by 1, or have a state in each column; it is 5 by 1', @() kr5('energy', (1:5)', 1:6));
reports('redysim:shape', 'it is 0 by 0', @() kr5('energy', [], 1:6));
reports('redysim:shape', '2 by 6 by more', @() kr5('energy', ones(2, 6, 2), 1:6));
reports('redysim:shape', 'v of energy has 3 states, an argument before it 2', @() kr5('energy', ones(6, 2), ones(6, 3)));
reports('redysim:shape', 'must be 6 by 5, or have a state in each page', @() machine('frame_forces', 1:5, 1:30));
reports('redysim:type', 'q of energy must be a full array of real doubles, not single', @() pendulum('energy', single(1), 1));
reports('redysim:type', 'not char', @() pendulum('energy', '1', 1));
reports('redysim:type', 'not complex double', @() pendulum('energy', 1i, 1));
reports('redysim:type', 'not sparse double', @() pendulum('energy', sparse(1), 1));
reports('redysim:value', 'v of energy must have finite numbers; number 2 of state 3 is NaN', ...
    @() kr5('energy', 1:6, [ones(6, 2), [1; NaN; 1; 1; 1; 1]]));
reports('redysim:value', 'is Inf', @() kr5('energy', [1:5 Inf], 1:6));
reports('redysim:result', 'energy has no finite result at state 1', @() kr5('energy', 1:6, 1e200 * (1:6)));

% Where it is not compiled, the function reports how it is.
addpath(fullfile(made, 'uncompiled'));
reports('redysim:compile', 'mex -output uncompiled uncompiled_mex.c uncompiled.c', @() uncompiled('neutral'));
disp('gateways: all as expected');
end

function reports(identifier, words, call)
    try
        call();
    catch fault
        matches = strcmp(fault.identifier, identifier) && ~isempty(strfind(lower(fault.message), lower(words)));
        assert(matches, '%s instead of %s: %s', fault.identifier, identifier, fault.message);
        return
    end
    error('%s is not reported: %s', identifier, func2str(call));
end

function two_results()
[kinetic, potential] = pendulum('energy', 1, 1);
end
